#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/matching/match_options.h"
#include "engine/synthesis/synthesis_options.h"

namespace vantage {

/// What a sequence run writes for each frame.
enum class SequenceOutput {
  kDisparity,
  kRightDisparity,
  kConfidence,
  kUnmatched,
  kPreview,
  kViews
};

/// Everything that decides which files a sequence run writes and what is in them.
struct SequenceOptions {
  MatchOptions match;  ///< without disparities_y
  SynthesisOptions synthesis;
  std::vector<SequenceOutput> save = {SequenceOutput::kDisparity};  ///< at least one
  /// Positions XS of the new views in baselines, within ±16; exactly when kViews is saved.
  std::vector<double> views_x;
  /// Extension of the disparity and confidence files without the dot: pfm, png (not with
  /// kConfidence), tiff, exr or npy.
  std::string disparity_format = "pfm";
  /// Frames under way at the same time, 1..64; default min(threads + 1, 8).
  std::optional<int> in_flight;

  /// Throws UsageError naming the field, its value and its limit.
  void validate() const;
  [[nodiscard]] bool saves(SequenceOutput output) const;
};

/// Where the files of a run are: DIR/disparity/000000.pfm, DIR/right-disparity/…,
/// DIR/confidence/, DIR/unmatched/, DIR/preview/, DIR/views/000000.png (one view) or
/// DIR/views/0.25/000000.png (several).
class SequenceLayout {
 public:
  SequenceLayout(std::filesystem::path folder, const SequenceOptions& options);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// All folders that files go to. For kViews one per view.
  [[nodiscard]] std::vector<std::filesystem::path> folders() const;
  /// `extension` comes without the dot; `view` counts from 0 and matters for kViews only.
  [[nodiscard]] std::filesystem::path file(SequenceOutput output, int frame,
                                           const std::string& extension, int view = 0) const;

 private:
  [[nodiscard]] std::filesystem::path folder_of(SequenceOutput output, int view) const;

  std::filesystem::path folder_;
  std::vector<SequenceOutput> save_;
  std::vector<double> views_x_;
};

}  // namespace vantage
