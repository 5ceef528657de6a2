#pragma once

#include <array>
#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/io/preview.h"
#include "engine/sequence/pair_source.h"
#include "engine/sequence/sequence_options.h"
#include "engine/synthesis/intensity_fit.h"

namespace vantage {

/// A stretch of frames without a cut, and what all its frames share.
struct Shot {
  int first_frame = 0;
  int end_frame = 0;                           ///< behind the last one
  std::array<IntensityFit, 4> intensity = {};  ///< of the right images on the left ones (3.9)
  PreviewRange preview_range;                  ///< of the maps

  friend bool operator==(const Shot&, const Shot&) = default;
};

/// Shots that follow each other without gaps, at least one.
struct ShotTable {
  std::vector<Shot> shots;

  /// The shot of a frame; of frames outside the first or the last one.
  [[nodiscard]] const Shot& shot_of(int frame) const;
  friend bool operator==(const ShotTable&, const ShotTable&) = default;
};

/// As text that brings back the same bits. The second throws Error saying what is wrong.
std::string to_json(const ShotTable& table);
ShotTable shot_table_from_json(const std::string& text);

/// The table in `file`; empty where there is no such file. Throws Error naming the file when it
/// cannot be read.
std::optional<ShotTable> read_shot_table(const std::filesystem::path& file);

/// Writes `table` as `file`, whole or not at all, unless another process has been quicker. Returns
/// what the file holds then: all parts of a run must go by the same table. Throws Error.
ShotTable keep_shot_table(const std::filesystem::path& file, const ShotTable& table);

/// Where a survey stands: it looks at all frames, then at a few more closely.
struct SurveyProgress {
  int frames_done = 0;
  int frames_total = 0;
};

/// What a survey may do with pairs and whom it tells.
struct SurveyHooks {
  /// Makes a decoded pair what matching gets (rectification); called concurrently. Empty: nothing.
  std::function<void(FramePair&)> prepare;
  std::function<void(const SurveyProgress&)> progress;  ///< never concurrently
  const std::atomic<bool>* stop = nullptr;
  int in_flight = 64;  ///< most pairs held at once, ≥ 1; no more than threads are
};

/// Finds the shots of frames [first_frame, end_frame) of `pairs`, 0 ≤ first < end ≤ pair_count(),
/// by their left images (shot_cuts.h), the only ones then decoded, and matches up to three frames
/// of each (first, middle, last) with options.match: the sums of the regression (3.11), taken at XS
/// = 0.5 as options.synthesis says, are added up over them; the preview range is that of the 1st to
/// the 99th percentile of the disparities of their primary maps, widened on both sides by 1/20 and
/// at least ½ px. Frames that cannot be read are left out: they are no cut, and a shot without any
/// sample has the identity and the search range.
///
/// Identical for any `execution`. Leaves `pairs` anywhere: use skip_to(). Empty when `stop` was
/// raised. Throws UsageError where the options do not suit the images.
std::optional<ShotTable> survey_shots(PairSource& pairs, int first_frame, int end_frame,
                                      const SequenceOptions& options, const SurveyHooks& hooks,
                                      Execution& execution);

}  // namespace vantage
