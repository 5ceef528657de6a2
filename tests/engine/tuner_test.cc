#include "engine/tuning/tuner.h"

#include "engine/tuning/candidate_ladder.h"
#include "tests/engine/engine_test.h"

namespace vantage::tuner_test {

/// Settings with every field known.
struct Plan {
  int threads = 8;
  int in_flight = 10;
  int strip_px = 320;
  int band_px = 240;
  int iterations = 10;
};

/// How long a frame takes on a made-up machine, in seconds.
using Landscape = std::function<double(const Plan&)>;

constexpr int kThreads = 8;
constexpr int kWidth = 1280;
constexpr int kHeight = 960;
constexpr int kIterations = 10;
constexpr int kBytesPerColumn = 256;
constexpr int kFirstCacheBytes = 131072;

int divide_up(int total, int part) { return (total + part - 1) / part; }

/// Seconds of nothing but cells.
constexpr double kCells = 0.2;

/// A bowl in the logarithms: strips of 150 px, bands of 480 px, all threads.
double bowl(const Plan& plan) {
  const auto away = [](int value, double best) { return std::pow(std::log2(value / best), 2); };
  return kCells * (1 + 0.1 * away(plan.strip_px, 150) + 0.05 * away(plan.band_px, 480)) *
         (kThreads + 1.0) / (plan.threads + 1.0);
}

/// Halo columns and two caches with steep edges; threads that wait for the last.
double caches(const Plan& plan) {
  const double halo = 1 + 2.0 * plan.iterations / plan.strip_px;
  const double passes = 1 + 0.15 * (divide_up(kIterations, plan.iterations) - 1);
  const int bytes = plan.strip_px * kBytesPerColumn * plan.iterations;
  const double level = bytes <= kFirstCacheBytes ? 1 : bytes <= 8 * kFirstCacheBytes ? 1.35 : 3.5;
  const int tasks = divide_up(kWidth, plan.strip_px) * divide_up(kHeight, plan.band_px);
  const double waiting = static_cast<double>(divide_up(tasks, plan.threads)) * plan.threads / tasks;
  return kCells * halo * passes * level * waiting * kThreads / plan.threads;
}

/// Threads that share cores only disturb each other.
double shared_cores(const Plan& plan) {
  const int cores = 4;
  const double speed = std::min(plan.threads, cores) - 0.3 * std::max(0, plan.threads - cores);
  return bowl({.threads = kThreads, .strip_px = plan.strip_px, .band_px = plan.band_px}) *
         kThreads / speed;
}

/// Frames in flight hide what is not parallel in a frame, and then overflow the cache.
double frames(const Plan& plan) {
  const double hidden = 0.5 / std::min(plan.in_flight, 5);
  return kCells * (1 + hidden) * (plan.in_flight > 6 ? 1.3 : 1.0);
}

double flat(const Plan& /*plan*/) { return kCells; }

/// Nothing is better than the default plan.
double default_is_best(const Plan& plan) {
  const Plan best;
  const auto away = [](int value, int best_value) {
    return std::abs(std::log2(static_cast<double>(value) / best_value));
  };
  return kCells *
         (1 + 0.3 * (away(plan.strip_px, best.strip_px) + away(plan.band_px, best.band_px) +
                     away(plan.iterations, best.iterations) + away(plan.threads, best.threads) +
                     away(plan.in_flight, best.in_flight)));
}

/// A made-up machine: its clock only runs while it works.
class MadeUpMachine : public TuningSubject {
 public:
  MadeUpMachine(Landscape landscape, double noise, std::uint64_t seed)
      : landscape_(std::move(landscape)), noise_(noise), random_(seed) {}

  static Plan plan_of(const TunedSettings& settings) {
    const Plan by_default;
    return {.threads = settings.threads.value_or(by_default.threads),
            .in_flight = settings.frames_in_flight.value_or(by_default.in_flight),
            .strip_px = settings.strip_width_px.value_or(by_default.strip_px),
            .band_px = settings.band_height_px.value_or(by_default.band_px),
            .iterations = settings.iterations_per_pass.value_or(by_default.iterations)};
  }
  [[nodiscard]] double true_seconds(const TunedSettings& settings) const {
    return landscape_(plan_of(settings));
  }

  static std::vector<int> values(const TuningCoordinate& coordinate, const TunedSettings& incumbent,
                                 bool finely) {
    const Plan plan = plan_of(incumbent);
    const auto parts = [&](int total, int part) {
      std::vector<int> sizes;
      for (const int count :
           finely ? fine_ladder(divide_up(total, part), total / 16) : coarse_ladder(total / 16)) {
        sizes.push_back(divide_up(total, count));
      }
      return sizes;
    };
    const auto numbers = [&](int value, int max) {
      return finely ? fine_ladder(value, max) : coarse_ladder(max);
    };
    if (coordinate.field == &TunedSettings::threads) {
      return numbers(plan.threads, kThreads);
    }
    if (coordinate.field == &TunedSettings::frames_in_flight) {
      return numbers(plan.in_flight, 16);
    }
    if (coordinate.field == &TunedSettings::strip_width_px) {
      return parts(kWidth, plan.strip_px);
    }
    return coordinate.field == &TunedSettings::band_height_px
               ? parts(kHeight, plan.band_px)
               : numbers(plan.iterations, kIterations);
  }

  std::vector<TunedSettings> candidates(const TuningCoordinate& coordinate,
                                        const TunedSettings& incumbent, bool finely) override {
    std::vector<TunedSettings> all;
    for (const int value : values(coordinate, incumbent, finely)) {
      all.push_back(incumbent);
      all.back().*coordinate.field = value;
      if (coordinate.field == &TunedSettings::iterations_per_pass) {
        // As a planner that knows the first cache would have it.
        all.push_back(all.back());
        all.back().strip_width_px = kFirstCacheBytes / (kBytesPerColumn * value);
      }
    }
    if (incumbent.*coordinate.field) {
      all.push_back(incumbent);
      (all.back().*coordinate.field).reset();
    }
    return all;
  }
  double expected_seconds(const TunedSettings& settings) override {
    return true_seconds(settings) * (1 + 4 * noise_) * drift_;
  }
  double measure(const TunedSettings& settings) override {
    const double deviation =
        std::clamp(std::normal_distribution(0.0, noise_)(random_), -3.5 * noise_, 3.5 * noise_);
    const double seconds = true_seconds(settings) * (1 + deviation) * drift_;
    now_ += seconds;
    drift_ *= drift_per_measurement_;
    ++measurements_;
    return seconds;
  }
  /// Everything takes so much longer from one measurement to the next.
  void set_drift(double factor) { drift_per_measurement_ = factor; }

  [[nodiscard]] TuningClock clock() const {
    return [this] { return now_; };
  }
  [[nodiscard]] int measurements() const { return measurements_; }

 private:
  Landscape landscape_;
  double noise_;
  std::mt19937_64 random_;
  double now_ = 1000;
  double drift_ = 1;
  double drift_per_measurement_ = 1;
  int measurements_ = 0;
};

/// The least time over all that the coarse ladders reach.
double best_of_all(const Landscape& landscape) {
  const auto coarse = [](std::size_t index) {
    return MadeUpMachine::values(kTuningCoordinates[index], {}, false);
  };
  double best = std::numeric_limits<double>::max();
  for (const int threads : coarse(0)) {
    for (const int in_flight : coarse(1)) {
      for (const int strip : coarse(2)) {
        for (const int iterations : coarse(3)) {
          for (const int band : coarse(4)) {
            best = std::min(best, landscape({threads, in_flight, strip, band, iterations}));
          }
        }
      }
    }
  }
  return best;
}

struct Case {
  std::string name;
  Landscape landscape;
  double noise;
};

void PrintTo(const Case& one, std::ostream* stream) { *stream << one.name; }

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const auto& [name, landscape] :
       std::vector<std::pair<std::string, Landscape>>{{"Bowl", bowl},
                                                      {"Caches", caches},
                                                      {"SharedCores", shared_cores},
                                                      {"Frames", frames},
                                                      {"Flat", flat},
                                                      {"DefaultIsBest", default_is_best}}) {
    all.push_back({name, landscape, 0});
    all.push_back({name + "Noisy", landscape, 0.02});
  }
  return all;
}

class TunerOnLandscape : public testing::TestWithParam<Case> {
 protected:
  static constexpr int kSeeds = 12;

  static TuningOutcome tune(MadeUpMachine& machine, const TunedSettings& start = {},
                            double budget_seconds = 1000) {
    const TuningClock clock = machine.clock();
    return Tuner(machine, machine, clock, {.budget_seconds = budget_seconds, .start = start})
        .tune();
  }
};

TEST_P(TunerOnLandscape, FindsTheOptimum) {
  const double best = best_of_all(GetParam().landscape);
  for (int seed = 0; seed < kSeeds; ++seed) {
    MadeUpMachine machine(GetParam().landscape, GetParam().noise, static_cast<std::uint64_t>(seed));
    const TuningOutcome outcome = tune(machine);
    EXPECT_GE(best / machine.true_seconds(outcome.settings), 0.95)
        << "seed " << seed << ": " << to_string(outcome.settings);
    EXPECT_TRUE(outcome.complete);
  }
}

TEST_P(TunerOnLandscape, RecoversFromBadPlans) {
  const double best = best_of_all(GetParam().landscape);
  const std::vector<TunedSettings> bad_plans = {
      {.strip_width_px = 16},
      {.strip_width_px = kWidth, .band_height_px = kHeight},
      {.strip_width_px = 16, .band_height_px = 4, .iterations_per_pass = 1},
      {.threads = 1},
      {.threads = 3, .strip_width_px = kWidth, .iterations_per_pass = 3, .frames_in_flight = 1}};
  for (std::size_t i = 0; i < bad_plans.size(); ++i) {
    MadeUpMachine machine(GetParam().landscape, GetParam().noise, i);
    const TuningOutcome outcome = tune(machine, bad_plans[i], 1000);
    EXPECT_GE(best / machine.true_seconds(outcome.settings), 0.95)
        << to_string(bad_plans[i]) << " became " << to_string(outcome.settings);
  }
}

TEST_P(TunerOnLandscape, IsNeverBehindTheDefaultPlan) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    for (const double budget : {0.5, 2.0, 10.0, 40.0}) {
      MadeUpMachine machine(GetParam().landscape, std::max(0.1, GetParam().noise),
                            static_cast<std::uint64_t>(seed));
      const TuningOutcome outcome = tune(machine, {.strip_width_px = 16}, budget);
      EXPECT_LE(machine.true_seconds(outcome.settings), 1.02 * machine.true_seconds({}))
          << "seed " << seed << ": " << to_string(outcome.settings);
    }
  }
}

TEST_P(TunerOnLandscape, KeepsToTheBudget) {
  for (const double budget : {0.001, 0.3, 1.0, 3.0, 17.0, 60.0}) {
    MadeUpMachine machine(GetParam().landscape, GetParam().noise, 7);
    const TuningClock clock = machine.clock();
    const double begin = clock();
    const TuningOutcome outcome = tune(machine, {}, budget);
    EXPECT_LE(clock() - begin, budget);
    EXPECT_EQ(outcome.elapsed_seconds, clock() - begin);
    EXPECT_EQ(outcome.measurements, machine.measurements());
  }
}

INSTANTIATE_TEST_SUITE_P(All, TunerOnLandscape, testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name; });

TEST(Tuner, KeepsTheDefaultWhereNothingIsBetter) {
  int kept = 0;
  constexpr int kTries = 40;
  for (std::uint64_t seed = 0; seed < kTries; ++seed) {
    MadeUpMachine machine(seed % 2 == 0 ? flat : default_is_best, 0.05, seed);
    const TuningClock clock = machine.clock();
    const TuningOutcome outcome = Tuner(machine, machine, clock, {}).tune();
    if (outcome.settings == TunedSettings{}) {
      ++kept;
      EXPECT_EQ(outcome.ratio_to_default, 1);
      EXPECT_EQ(outcome.frame_seconds, outcome.default_frame_seconds);
    }
  }
  // Chance makes a few winners of equals.
  EXPECT_GE(kept, kTries - 2);
}

TEST(Tuner, IsNotMisledByAMachineThatSlowsDown) {
  MadeUpMachine machine(caches, 0.01, 3);
  machine.set_drift(1.004);
  const TuningClock clock = machine.clock();
  const TuningOutcome outcome = Tuner(machine, machine, clock, {.budget_seconds = 300}).tune();
  EXPECT_GE(best_of_all(caches) / machine.true_seconds(outcome.settings), 0.93)
      << to_string(outcome.settings);
  EXPECT_NEAR(outcome.ratio_to_default,
              machine.true_seconds(outcome.settings) / machine.true_seconds({}), 0.02);
}

TEST(Tuner, LetsTheFinalSubjectDecide) {
  // What the search finds is slower where it counts.
  MadeUpMachine searched(bowl, 0, 1);
  MadeUpMachine faithful(default_is_best, 0, 1);
  const TuningClock clock = searched.clock();
  const TuningOutcome outcome = Tuner(searched, faithful, clock, {}).tune();
  EXPECT_EQ(to_string(outcome.settings), "default");
  EXPECT_GE(outcome.rounds, 3);
}

TEST(Tuner, RecordsWhatWasTried) {
  MadeUpMachine machine(bowl, 0, 1);
  const TuningClock clock = machine.clock();
  const TuningOutcome outcome = Tuner(machine, machine, clock, {}).tune();
  ASSERT_FALSE(outcome.trials.empty());
  EXPECT_EQ(to_string(outcome.trials.front().settings), "default");
  EXPECT_EQ(outcome.trials.front().ratio_to_default, 1);
  for (const TuningTrial& trial : outcome.trials) {
    ASSERT_FALSE(trial.frame_seconds.empty());
    EXPECT_DOUBLE_EQ(trial.median_seconds(), machine.true_seconds(trial.settings));
    ASSERT_TRUE(trial.ratio_to_default) << to_string(trial.settings);
    EXPECT_NEAR(*trial.ratio_to_default,
                machine.true_seconds(trial.settings) / machine.true_seconds({}), 1e-9);
  }
  EXPECT_DOUBLE_EQ(outcome.frame_seconds, machine.true_seconds(outcome.settings));
  EXPECT_DOUBLE_EQ(outcome.default_frame_seconds, machine.true_seconds({}));
  EXPECT_NEAR(outcome.ratio_to_default, outcome.frame_seconds / outcome.default_frame_seconds,
              1e-12);
}

TEST(Tuner, StopsWhenToldTo) {
  MadeUpMachine machine(bowl, 0, 1);
  const TuningClock clock = machine.clock();
  std::atomic<bool> stop = false;
  Tuner tuner(machine, machine, clock, {.stop = &stop});
  tuner.on_progress([&](const TunerProgress& progress) { stop = progress.measurements == 9; });
  const TuningOutcome outcome = tuner.tune();
  EXPECT_TRUE(outcome.interrupted);
  EXPECT_FALSE(outcome.complete);
  EXPECT_EQ(outcome.measurements, 9);
}

TEST(Tuner, RefusesABudgetThatIsNone) {
  MadeUpMachine machine(flat, 0, 1);
  const TuningClock clock = machine.clock();
  for (const double budget : {0.0, -1.0, 1e9, std::nan("")}) {
    EXPECT_THROW(Tuner(machine, machine, clock, {.budget_seconds = budget}), UsageError);
  }
  EXPECT_THROW(Tuner(machine, machine, clock, {.start = {.threads = 0}}), UsageError);
}

}  // namespace vantage::tuner_test
