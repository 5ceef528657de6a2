#pragma once

#include <atomic>
#include <functional>
#include <optional>

#include "engine/tuning/tuner.h"
#include "engine/tuning/tuning_file.h"
#include "engine/tuning/tuning_key.h"

namespace vantage {

/// What to tune for.
struct TuningRequest {
  MatchOptions match;          ///< disparities known
  ExecutionOptions execution;  ///< what is set is not searched
  TunedImages images;          ///< sides 1..16384
  double budget_seconds = 60;  ///< for all that tune_machine() does, above 0, at most 10^6
  bool for_match = true;
  bool for_run = true;

  /// Throws UsageError naming the field, its value and its limits.
  void validate() const;
};

/// What was measured for one use, and what came of it.
struct TunedUseReport {
  TunedUse use = TunedUse::kMatch;
  int search_rows = 0;  ///< height of the images in the search
  int final_rows = 0;   ///< and in the final comparison
  int frames = 1;       ///< of one measurement
  bool searched_bands = false;
  TuningOutcome outcome;
};

struct TuningReport {
  TuningKey key;
  std::vector<TunedUseReport> uses;  ///< of those asked for, the ones that time was left for
  double elapsed_seconds = 0;
  bool interrupted = false;
};

/// Tunes matching of made-up images of the size asked for. Where a frame takes long, lower images
/// are measured: the height changes nothing inside of a strip. Half of the budget is for `match`,
/// the rest for `run`, if both are wanted. `on_progress` and `stop` as of Tuner.
///
/// Thread rule: one call at a time. Throws UsageError for invalid options, Error where no pixel has
/// a candidate.
TuningReport tune_machine(const TuningRequest& request,
                          const std::function<void(TunedUse, const TunerProgress&)>& on_progress,
                          const std::atomic<bool>* stop);

/// What a tuning file holds of it: nothing of a use that was interrupted. `date` as of TunedPlan.
TuningEntry entry_of(const TuningReport& report, const std::string& date);

}  // namespace vantage
