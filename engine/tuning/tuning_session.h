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
  ExecutionOptions execution;  ///< fields that are set are not searched
  TunedImages images;          ///< sides 1..16384
  double budget_seconds = 60;  ///< for all of tune_machine(), above 0, at most 10^6
  bool for_match = true;
  bool for_run = true;

  /// Throws UsageError naming the field, its value and its limits.
  void validate() const;
};

/// Measurements and result for one use.
struct TunedUseReport {
  TunedUse use = TunedUse::kMatch;
  int search_rows = 0;  ///< height of the images in the search
  int final_rows = 0;   ///< height of the images in the final comparison
  int frames = 1;       ///< per measurement
  bool searched_bands = false;
  TuningOutcome outcome;
};

struct TuningReport {
  TuningKey key;
  std::vector<TunedUseReport> uses;  ///< of those requested, the ones with enough time
  double elapsed_seconds = 0;
  bool interrupted = false;
};

/// Tunes matching on synthetic images of the requested size. If a frame takes long, lower images
/// are measured: the height does not affect the work inside a strip. If both are requested, half of
/// the budget is for `match`, the rest for `run`. `on_progress` and `stop` as in Tuner.
///
/// Thread rule: one call at a time. Throws UsageError for invalid options, Error when no pixel has
/// a candidate.
TuningReport tune_machine(const TuningRequest& request,
                          const std::function<void(TunedUse, const TunerProgress&)>& on_progress,
                          const std::atomic<bool>* stop);

/// The entry for a tuning file, without interrupted uses. `date` as in TunedPlan.
TuningEntry entry_of(const TuningReport& report, const std::string& date);

}  // namespace vantage
