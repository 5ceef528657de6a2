#pragma once

#include <array>
#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/io/images/preview.h"
#include "engine/sequence/options/sequence_options.h"
#include "engine/sequence/pairs/frame_range.h"
#include "engine/sequence/pairs/pair_source.h"
#include "engine/sequence/shots/shot_cuts.h"
#include "engine/synthesis/intensity_fit.h"

namespace vantage {

/// Consecutive frames without a cut, and their common values.
struct Shot {
  int first_frame = 0;
  int end_frame = 0;                           ///< after the last one
  std::array<IntensityFit, 4> intensity = {};  ///< of the right images on the left ones (3.9)
  PreviewRange preview_range;                  ///< of the maps
  std::optional<DisparityRange> search = std::nullopt;  ///< found in it; empty: that of the run

  friend bool operator==(const Shot&, const Shot&) = default;
};

/// Contiguous shots, at least one.
struct ShotTable {
  std::vector<Shot> shots;

  /// The shot of a frame; the first or last one for frames outside.
  [[nodiscard]] const Shot& shot_of(int frame) const;
  friend bool operator==(const ShotTable&, const ShotTable&) = default;
};

/// The shots of `frames`, whose cuts are known: without fits and ranges of their own.
ShotTable shots_at(const ShotCuts& cuts, FrameRange frames, const SequenceOptions& options);

/// JSON text that preserves all bits. The second throws Error with the reason.
std::string to_json(const ShotTable& table);
ShotTable shot_table_from_json(const std::string& text);

/// The table in `file`; empty if there is no such file. Throws Error naming the file when it cannot
/// be read.
std::optional<ShotTable> read_shot_table(const std::filesystem::path& file);

/// Writes `table` to `file` atomically, unless another process has already written it. Returns the
/// content of the file: all parts of a run must use the same table. Throws Error.
ShotTable keep_shot_table(const std::filesystem::path& file, const ShotTable& table);

/// Progress of a survey: it scans all frames, then matches a few.
struct SurveyProgress {
  int frames_done = 0;
  int frames_total = 0;
};

/// Preparation and callbacks of a survey.
struct SurveyHooks {
  /// Prepares a decoded pair for matching (rectification); called concurrently. Empty: nothing.
  std::function<void(FramePair&)> prepare;
  std::function<void(const SurveyProgress&)> progress;  ///< never concurrently
  const std::atomic<bool>* stop = nullptr;
  int in_flight = 64;  ///< maximum pairs held at once, ≥ 1; at most the number of threads
};

/// Finds the shots of frames [first_frame, end_frame) of `pairs`, 0 ≤ first < end ≤ pair_count(),
/// by their left images (shot_cuts.h), decoding only these. With SearchScope::kShot, the
/// search range of a shot is the union of find_disparity_range() over up to five of its frames,
/// from the first to the last. If options.needs_matched_shots(), up to three frames of each (first,
/// middle, last) are matched with options.match in that range: the sums of the regression (3.11),
/// taken at XS = 0.5 with options.synthesis, are added over them; the preview range is that of the
/// 1st to the 99th percentile of the disparities of their primary maps, widened on both sides by
/// 1/20 and at least ½ px. Frames that cannot be read are ignored: they are no cut, and a shot
/// without samples has the identity and the search range.
///
/// Identical for any `execution`. Leaves `pairs` at an unspecified position: use skip_to(). Empty
/// when `stop` was set. Throws UsageError if the options do not fit the images.
std::optional<ShotTable> survey_shots(PairSource& pairs, int first_frame, int end_frame,
                                      const SequenceOptions& options, const SurveyHooks& hooks,
                                      Execution& execution);

}  // namespace vantage
