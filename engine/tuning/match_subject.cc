#include "engine/tuning/match_subject.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/matching/aggregation/aggregation_table.h"
#include "engine/tuning/candidate_ladder.h"

namespace vantage {
namespace {

// Candidates that the cost model expects to take this many times as long as the best are left out;
// the model is not trusted further.
constexpr double kHopelessModelRatio = 4;
// Expected durations are multiplied by this, and by more if only the cost model predicts them,
// because the first measurement also warms up.
constexpr double kMeasuredMargin = 1.2;
constexpr double kModelMargin = 2.5;
// Faster frames are repeated for this long: short times are mostly noise.
constexpr std::chrono::milliseconds kMinMeasurement{25};
// Runners keep their scratch memory and threads; the least recently used ones are evicted.
constexpr std::size_t kMaxRunners = 12;
constexpr std::size_t kMaxRunnerBytes = std::size_t{3} << 29;
// Limits of the search: narrower strips, lower bands and more bands per thread are not tried.
constexpr int kMinStripColumns = 16;
constexpr int kMinBandRows = 8;
constexpr int kMaxBandsPerThread = 16;
// The planner cuts longer chains at least once.
constexpr int kMaxPasses = 32;

int divide_up(int total, int part) { return (total + part - 1) / part; }

/// Part sizes of `total`: for all numbers of parts up to `max_parts`, or only near parts of
/// `size`.
std::vector<int> part_sizes(int total, int size, int max_parts, bool finely) {
  max_parts = std::max(1, max_parts);
  std::vector<int> sizes;
  for (const int count :
       finely ? fine_ladder(divide_up(total, size), max_parts) : coarse_ladder(max_parts)) {
    sizes.push_back(divide_up(total, count));
  }
  return sizes;
}

/// Whether the finest level has passes of iterations. Windows have none.
bool is_iterative(const MethodParameters& parameters) {
  return aggregation_of(parameters).is_iterative && parameters.iterations > 1 &&
         parameters.window_levels == 0;
}

bool is_same_plan(const scheduler::ChainPlan& a, const scheduler::ChainPlan& b) {
  return a.steps == b.steps && a.step_rows == b.step_rows &&
         std::ranges::equal(a.passes, b.passes, [](const auto& left, const auto& right) {
           return left.end_stage == right.end_stage && left.strip_columns == right.strip_columns &&
                  left.band_rows == right.band_rows;
         });
}

}  // namespace

MatchSubject::MatchSubject(const MatchSubjectOptions& options, const TuningPair& pair)
    : options_(options), pair_(pair), machine_(scheduler::detect_machine()) {
  options_.match.raw = true;
  plan_all({TunedSettings{}});
}

MatchSubject::~MatchSubject() = default;

int MatchSubject::threads_of(const TunedSettings& settings) const {
  return thread_count(with_tuned(options_.execution, settings), machine_);
}

bool MatchSubject::is_fixed(const TuningCoordinate& coordinate) const {
  const ExecutionOptions& execution = options_.execution;
  if (coordinate.field == &TunedSettings::threads) {
    return execution.threads || execution.executor == scheduler::ExecutorKind::kSerial;
  }
  if (coordinate.field == &TunedSettings::strip_width_px) {
    return execution.strip_width_px.has_value();
  }
  if (coordinate.field == &TunedSettings::band_height_px) {
    return execution.band_height_px || !options_.searches_bands;
  }
  if (coordinate.field == &TunedSettings::iterations_per_pass) {
    return execution.iterations_per_pass || !is_iterative(options_.match.resolved());
  }
  return false;
}

std::vector<int> MatchSubject::values(const TuningCoordinate& coordinate,
                                      const TunedSettings& incumbent, bool finely) {
  const scheduler::ChainPlan& plan = known(incumbent).plan;
  const scheduler::PassPlan& pass = plan.passes.back();
  const int threads = threads_of(incumbent);
  if (coordinate.field == &TunedSettings::threads) {
    if (finely) {
      return fine_ladder(threads, machine_.hardware_threads);
    }
    std::vector<int> numbers = {machine_.hardware_threads};
    for (int number = machine_.cores; number >= 1; number /= 2) {
      numbers.push_back(number);
    }
    return numbers;
  }
  if (coordinate.field == &TunedSettings::strip_width_px) {
    const int width = pair_.left.width();
    return part_sizes(width, pass.strip_columns, width / kMinStripColumns, finely);
  }
  if (coordinate.field == &TunedSettings::band_height_px) {
    const int rows = std::max(1, plan.step_rows);
    return part_sizes(rows, pass.band_rows,
                      std::min(rows / kMinBandRows, kMaxBandsPerThread * threads), finely);
  }
  if (coordinate.field == &TunedSettings::iterations_per_pass) {
    const int iterations = options_.match.resolved().iterations;
    const int of_pass = divide_up(iterations, static_cast<int>(plan.passes.size()));
    return part_sizes(iterations, incumbent.iterations_per_pass.value_or(of_pass),
                      std::min(iterations, kMaxPasses), finely);
  }
  return more_values(coordinate, incumbent, finely);
}

std::vector<int> MatchSubject::more_values(const TuningCoordinate& /*coordinate*/,
                                           const TunedSettings& /*incumbent*/,
                                           bool /*finely*/) const {
  return {};
}

std::vector<TunedSettings> MatchSubject::candidates(const TuningCoordinate& coordinate,
                                                    const TunedSettings& incumbent, bool finely) {
  if (is_fixed(coordinate)) {
    return {};
  }
  const bool decides_strips = coordinate.field == &TunedSettings::threads ||
                              coordinate.field == &TunedSettings::iterations_per_pass;
  std::vector<TunedSettings> all;
  const auto add = [&](const TunedSettings& settings) {
    if (std::ranges::find(all, settings) == all.end()) {
      all.push_back(settings);
    }
  };
  for (const int value : values(coordinate, incumbent, finely)) {
    TunedSettings settings = incumbent;
    settings.*coordinate.field = value;
    add(settings);
    if (decides_strips) {
      // The best strips change: let the cost model choose them again.
      settings.strip_width_px.reset();
      settings.band_height_px.reset();
      add(settings);
    }
  }
  if (incumbent.*coordinate.field) {
    TunedSettings settings = incumbent;
    (settings.*coordinate.field).reset();
    add(settings);
  }
  plan_all(all);
  const Known& before = known(incumbent);
  std::erase_if(all, [&](const TunedSettings& settings) {
    return threads_of(settings) == threads_of(incumbent) &&
           settings.frames_in_flight == incumbent.frames_in_flight &&
           is_same_plan(known(settings).plan, before.plan);
  });
  std::ranges::stable_sort(
      all, {}, [&](const TunedSettings& settings) { return known(settings).model_time; });
  if (!all.empty()) {
    const double limit =
        kHopelessModelRatio * std::min(known(all.front()).model_time, before.model_time);
    std::erase_if(
        all, [&](const TunedSettings& settings) { return known(settings).model_time > limit; });
  }
  return all;
}

double MatchSubject::expected_seconds(const TunedSettings& settings) {
  plan_all({settings});
  const Known& wanted = known(settings);
  if (wanted.work_seconds) {
    return kMeasuredMargin * *wanted.work_seconds;
  }
  double max = 0;  // maximum of the measured ones, seconds per unit of the model
  for (const Known& one : known_) {
    if (one.work_seconds) {
      max = std::max(max, *one.work_seconds / one.model_time);
    }
  }
  return kModelMargin * max * wanted.model_time;
}

double MatchSubject::measure(const TunedSettings& settings) {
  using Clock = std::chrono::steady_clock;
  plan_all({settings});
  Runner& runner = runner_of(settings);
  if (!runner.is_warm) {
    // The first frame also allocates memory from the system, which takes half as long again.
    runner.matcher.match(pair_.left, pair_.right, {.right = false, .unmatched = false},
                         runner.maps);
    runner.is_warm = true;
  }
  const Clock::time_point begin = Clock::now();
  const int frames = work(runner);
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  known(settings).work_seconds = seconds;
  return seconds / frames;
}

int MatchSubject::work(Runner& runner) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point end = Clock::now() + kMinMeasurement;
  int frames = 0;
  do {
    runner.matcher.match(pair_.left, pair_.right, {.right = false, .unmatched = false},
                         runner.maps);
    ++frames;
  } while (Clock::now() < end);
  return frames;
}

void MatchSubject::plan_all(const std::vector<TunedSettings>& settings) {
  std::vector<TunedSettings> fresh;
  std::vector<ExecutionOptions> executions;
  for (const TunedSettings& one : settings) {
    if (std::ranges::find(known_, one, &Known::settings) == known_.end()) {
      fresh.push_back(one);
      executions.push_back(with_tuned(options_.execution, one));
    }
  }
  if (fresh.empty()) {
    return;
  }
  const std::vector<scheduler::ChainPlan> plans =
      runner_of({}).matcher.plans(pair_.left, pair_.right, executions);
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    Known one;
    one.settings = fresh[i];
    one.plan = plans[i];
    one.model_time = scheduler::total_expected_time(plans[i]) / threads_of(fresh[i]);
    known_.push_back(std::move(one));
  }
}

MatchSubject::Known& MatchSubject::known(const TunedSettings& settings) {
  if (std::ranges::find(known_, settings, &Known::settings) == known_.end()) {
    plan_all({settings});
  }
  return *std::ranges::find(known_, settings, &Known::settings);
}

MatchSubject::Runner& MatchSubject::runner_of(const TunedSettings& settings) {
  const auto found = std::ranges::find_if(
      runners_, [&](const auto& runner) { return runner->settings == settings; });
  if (found != runners_.end()) {
    runners_.splice(runners_.begin(), runners_, found);
    return *runners_.front();
  }
  std::size_t bytes = 0;
  for (const auto& runner : runners_) {
    bytes += runner->execution.scratch().bytes_held();
  }
  while (!runners_.empty() && (runners_.size() >= kMaxRunners || bytes > kMaxRunnerBytes)) {
    bytes -= runners_.back()->execution.scratch().bytes_held();
    runners_.pop_back();
  }
  runners_.push_front(
      std::make_unique<Runner>(options_.match, settings, with_tuned(options_.execution, settings)));
  return *runners_.front();
}

}  // namespace vantage
