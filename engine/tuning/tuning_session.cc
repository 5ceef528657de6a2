#include "engine/tuning/tuning_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "engine/error.h"
#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/tuning/match_subject.h"
#include "engine/tuning/sequence_subject.h"

namespace vantage {
namespace {

constexpr int kMaxSide = 16384;  // of synthetic scenes
// A use's budget should suffice for this many measurements, and this share of it for the final
// comparison with this many of its higher images.
constexpr double kMeasurements = 150;
constexpr double kFinalMeasurements = 14;
constexpr double kFinalShare = 0.3;
// A pilot measures images of this many rows, which is also the minimum: for lower ones start-up
// costs dominate.
constexpr int kPilotRows = 64;
// From this share of the full height on, the full height is used.
constexpr double kNearlyAll = 0.7;
// Less time than this is not enough for a result.
constexpr double kMinSeconds = 0.05;

double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The subject of a use, with its images.
struct Bench {
  std::unique_ptr<const TuningPair> pair;  // address stays the same when the bench moves
  std::unique_ptr<MatchSubject> subject;
  int frames = 1;
};

class Session {
 public:
  explicit Session(const TuningRequest& request)
      : request_(request),
        height_(request.images.height_px),
        min_rows_(std::min(height_, kPilotRows + windows_height(request.match))) {
    Execution execution(request.execution);
    pair_ = make_tuning_pair(request.images.width_px, height_, request.match.disparities,
                             request.images.is_8_bit_grey, execution);
  }

  TunedUseReport tune(TunedUse use, double budget_seconds, const TuningClock& clock,
                      const std::function<void(const TunerProgress&)>& on_progress,
                      const std::atomic<bool>* stop) {
    const double begin = clock();
    TunedUseReport report;
    report.use = use;
    const double work_seconds = pilot(use);
    report.search_rows = rows_for(budget_seconds / kMeasurements, work_seconds);
    report.final_rows =
        std::max(report.search_rows,
                 rows_for(kFinalShare * budget_seconds / kFinalMeasurements, work_seconds));
    report.searched_bands = report.search_rows == height_;
    Bench search = make_bench(use, report.search_rows, report.searched_bands);
    std::optional<Bench> higher;
    if (report.final_rows > report.search_rows) {
      higher.emplace(make_bench(use, report.final_rows, false));
      higher->subject->measure({});  // shows how much time to reserve
    }
    report.frames = search.frames;
    TunerOptions options;
    options.budget_seconds = std::max(kMinSeconds, budget_seconds - (clock() - begin));
    options.stop = stop;
    Tuner tuner(*search.subject, higher ? *higher->subject : *search.subject, clock, options);
    tuner.on_progress(on_progress);
    report.outcome = tuner.tune();
    return report;
  }

 private:
  /// Complete windows need this many rows.
  static int windows_height(const MatchOptions& match) {
    const MethodParameters parameters = match.resolved();
    return aggregation_of(parameters).has_windows ? parameters.window_px : 0;
  }

  Bench make_bench(TunedUse use, int rows, bool searches_bands) const {
    Bench bench;
    bench.pair = std::make_unique<const TuningPair>(top_rows(pair_, rows));
    const MatchSubjectOptions options{
        .match = request_.match, .execution = request_.execution, .searches_bands = searches_bands};
    if (use == TunedUse::kMatch) {
      bench.subject = std::make_unique<MatchSubject>(options, *bench.pair);
    } else {
      auto subject = std::make_unique<SequenceSubject>(options, *bench.pair);
      bench.frames = subject->frames();
      bench.subject = std::move(subject);
    }
    return bench;
  }

  /// Seconds of one measurement of the lowest images.
  double pilot(TunedUse use) const {
    const Bench bench = make_bench(use, min_rows_, false);
    const double first = bench.subject->measure({});  // also allocates
    const double min = std::min(first, bench.subject->measure({}));
    return min * bench.frames;
  }

  /// The height at which a measurement takes about `seconds`, if the lowest images take
  /// `min_seconds`.
  [[nodiscard]] int rows_for(double seconds, double min_seconds) const {
    const double rows = min_rows_ * seconds / std::max(1e-9, min_seconds);
    return rows >= kNearlyAll * height_ ? height_ : std::max(min_rows_, static_cast<int>(rows));
  }

  const TuningRequest& request_;
  int height_;
  int min_rows_;
  TuningPair pair_;
};

TunedPlan plan_of(const TunedUseReport& use, const std::string& date) {
  const TuningOutcome& outcome = use.outcome;
  return {.settings = outcome.settings,
          .frame_seconds = outcome.frame_seconds,
          .default_frame_seconds = outcome.default_frame_seconds,
          .ratio_to_default = outcome.ratio_to_default,
          .measurements = outcome.measurements,
          .measured_rows = outcome.settings == TunedSettings{} ? use.search_rows : use.final_rows,
          .date = date};
}

}  // namespace

void TuningRequest::validate() const {
  match.validate();
  execution.validate();
  for (const int side : {images.width_px, images.height_px}) {
    if (side < 1 || side > kMaxSide) {
      throw UsageError(fmt::format("size is {}x{}, expected sides from 1 to {}", images.width_px,
                                   images.height_px, kMaxSide));
    }
  }
  if (!(budget_seconds > 0 && budget_seconds <= kMaxBudgetSeconds)) {
    throw UsageError(fmt::format("budget is {}, expected seconds above 0 and at most {}",
                                 budget_seconds, kMaxBudgetSeconds));
  }
}

TuningReport tune_machine(const TuningRequest& request,
                          const std::function<void(TunedUse, const TunerProgress&)>& on_progress,
                          const std::atomic<bool>* stop) {
  request.validate();
  const TuningClock clock = now_seconds;
  const double begin = clock();
  TuningReport report;
  report.key = make_tuning_key(scheduler::detect_machine(), request.match, request.execution,
                               request.images);
  Session session(request);
  const auto is_stopped = [&] { return stop != nullptr && stop->load(); };
  const auto tune = [&](TunedUse use, double share) {
    const double left = request.budget_seconds - (clock() - begin);
    if (left <= 0 || is_stopped()) {
      return;
    }
    report.uses.push_back(session.tune(
        use, share * left, clock,
        [&](const TunerProgress& progress) {
          if (on_progress) {
            on_progress(use, progress);
          }
        },
        stop));
  };
  if (request.for_match) {
    tune(TunedUse::kMatch, request.for_run ? 0.5 : 1);
  }
  if (request.for_run) {
    tune(TunedUse::kRun, 1);
  }
  report.elapsed_seconds = clock() - begin;
  report.interrupted = is_stopped();
  return report;
}

TuningEntry entry_of(const TuningReport& report, const std::string& date) {
  TuningEntry entry;
  entry.key = report.key;
  for (const TunedUseReport& use : report.uses) {
    if (!use.outcome.interrupted && use.outcome.frame_seconds > 0) {
      (use.use == TunedUse::kMatch ? entry.match : entry.run) = plan_of(use, date);
    }
  }
  return entry;
}

}  // namespace vantage
