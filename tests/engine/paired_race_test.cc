#include "engine/tuning/paired_race.h"

#include "tests/engine/engine_test.h"

namespace vantage::paired_race_test {

TunedSettings strips_of(int width_px) { return {.strip_width_px = width_px}; }

/// Times as they are told, one after the other; the last one for ever.
class ToldTimes : public TuningSubject {
 public:
  explicit ToldTimes(std::map<int, std::vector<double>> seconds) : seconds_(std::move(seconds)) {}

  std::vector<TunedSettings> candidates(const TuningCoordinate& /*coordinate*/,
                                        const TunedSettings& /*incumbent*/,
                                        bool /*finely*/) override {
    return {};
  }
  double expected_seconds(const TunedSettings& /*settings*/) override { return 1; }
  double measure(const TunedSettings& settings) override {
    const int width_px = *settings.strip_width_px;
    const std::vector<double>& all = seconds_.at(width_px);
    const int number = measured_[width_px]++;
    now_ += 1;
    return all[std::min(static_cast<std::size_t>(number), all.size() - 1)];
  }
  [[nodiscard]] int measured(int width_px) { return measured_[width_px]; }
  [[nodiscard]] TuningClock clock() const {
    return [this] { return now_; };
  }

 private:
  std::map<int, std::vector<double>> seconds_;
  std::map<int, int> measured_;
  double now_ = 0;
};

PairedComparison comparison(std::vector<double> ratios) { return {std::move(ratios)}; }

TEST(PairedComparison, IsWonBeyondNoiseOnly) {
  EXPECT_TRUE(comparison({0.9, 0.91, 0.9, 0.89, 0.9}).is_won(5));
  EXPECT_FALSE(comparison({0.9, 0.91, 0.9, 0.89}).is_won(5)) << "too few rounds";
  EXPECT_FALSE(comparison({0.9, 0.91, 0.9, 0.89, 1.1}).is_won(5)) << "one of five is lost";
  EXPECT_TRUE(comparison({0.9, 0.91, 0.9, 0.89, 0.9, 0.9, 1.1}).is_won(5)) << "one of seven";
  EXPECT_FALSE(comparison({0.995, 0.996, 0.995, 0.995, 0.995}).is_won(5)) << "hardly a gain";
  EXPECT_FALSE(comparison({0.99, 0.9, 0.999, 0.97, 0.8}).is_won(5)) << "the gain is within noise";
  EXPECT_FALSE(comparison({}).is_won(0));
}

TEST(PairedComparison, IsNotWonByLessThanThePlanDiffersFromItself) {
  PairedComparison comparison{{0.96, 0.955, 0.965, 0.96, 0.96, 0.958, 0.962, 0.96, 0.96}};
  EXPECT_TRUE(comparison.is_won(5)) << "4 % and nothing that speaks against it";
  EXPECT_EQ(comparison.noise(), 0);
  comparison.repeats = {1.01, 0.99, 1, 1.02, 0.99, 1, 1, 0.98, 1.01};
  EXPECT_NEAR(comparison.noise(), 0.0148, 1e-4);
  EXPECT_TRUE(comparison.is_won(5));
  // A busy machine: the plan takes 8 % more or less from one time to the next.
  comparison.repeats = {1.08, 0.9, 1.02, 0.92, 1.07, 1.11, 0.93, 0.99, 1.05};
  EXPECT_FALSE(comparison.is_won(5));
}

TEST(PairedRace, MeasuresTheIncumbentOnBothSidesOfTheChallenger) {
  // The incumbent takes 10 and 12 s by turns; the challenger 11, as long in the mean.
  ToldTimes subject({{1, {10, 10, 12, 10, 12, 10, 12, 10, 12, 10, 12}}, {2, {11}}});
  const TuningClock clock = subject.clock();
  BudgetedTrials trials(subject, clock, 1000, nullptr);
  const PairedComparison comparison = compare(strips_of(1), strips_of(2), 5, trials);
  for (const double ratio : comparison.ratios) {
    EXPECT_DOUBLE_EQ(ratio, 1);
  }
  EXPECT_EQ(comparison.repeats.size(), comparison.ratios.size());
  EXPECT_NEAR(comparison.noise(), 1.4826 * 0.2, 1e-9);
}

TEST(PairedRace, TakesTheFastestAndDropsOthersEarly) {
  ToldTimes subject({{1, {10}}, {2, {20}}, {3, {8}}, {4, {10.5}}, {5, {9}}});
  const TuningClock clock = subject.clock();
  BudgetedTrials trials(subject, clock, 1000, nullptr);
  const RaceResult result =
      race(strips_of(1), {strips_of(2), strips_of(3), strips_of(4), strips_of(5)}, trials);
  ASSERT_TRUE(result.winner);
  EXPECT_EQ(*result.winner, strips_of(3));
  EXPECT_DOUBLE_EQ(result.comparison.median_ratio(), 0.8);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(subject.measured(2), 1) << "twice as slow, once is enough";
  EXPECT_LT(subject.measured(4), subject.measured(3));
  EXPECT_EQ(subject.measured(1), subject.measured(3)) << "the incumbent is in every round";
}

TEST(PairedRace, KeepsTheIncumbentOfEquals) {
  ToldTimes subject({{1, {10}}, {2, {10}}, {3, {9.95}}});
  const TuningClock clock = subject.clock();
  BudgetedTrials trials(subject, clock, 1000, nullptr);
  const RaceResult result = race(strips_of(1), {strips_of(2), strips_of(3)}, trials);
  EXPECT_FALSE(result.winner);
  EXPECT_TRUE(result.complete);
}

TEST(PairedRace, OneGoodMeasurementDoesNotWin) {
  ToldTimes subject({{1, {10}}, {2, {3, 3, 10.2}}});
  const TuningClock clock = subject.clock();
  BudgetedTrials trials(subject, clock, 1000, nullptr);
  EXPECT_FALSE(race(strips_of(1), {strips_of(2)}, trials).winner);
}

TEST(PairedRace, AFirstMeasurementThatAllocatesDoesNotLose) {
  ToldTimes subject({{1, {10}}, {2, {13.5, 8}}});
  const TuningClock clock = subject.clock();
  BudgetedTrials trials(subject, clock, 1000, nullptr);
  EXPECT_TRUE(race(strips_of(1), {strips_of(2)}, trials).winner);
}

TEST(PairedRace, DecidesWithTheRoundsThatThereIsTimeFor) {
  // Each measurement takes a second: a scouting round of two, then rounds of two.
  for (const auto& [deadline, wins] : {std::pair(7.0, false), std::pair(8.0, true)}) {
    ToldTimes subject({{1, {10}}, {2, {8}}});
    const TuningClock clock = subject.clock();
    BudgetedTrials trials(subject, clock, deadline, nullptr);
    const RaceResult result = race(strips_of(1), {strips_of(2)}, trials);
    EXPECT_FALSE(result.complete);
    EXPECT_EQ(result.winner.has_value(), wins) << deadline;
    EXPECT_LE(clock(), deadline);
  }
}

TEST(PairedRace, ComparesInAsManyRoundsAsTold) {
  ToldTimes subject({{1, {10}}, {2, {8}}, {3, {12}}});
  const TuningClock clock = subject.clock();
  BudgetedTrials trials(subject, clock, 1000, nullptr);
  EXPECT_EQ(compare(strips_of(1), strips_of(2), 9, trials).rounds(), 9);
  EXPECT_EQ(compare(strips_of(1), strips_of(3), 9, trials).rounds(), 3) << "lost";
}

TEST(Median, IsTheMiddle) {
  EXPECT_EQ(median({3}), 3);
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(spread({5, 5, 5}), 0);
  EXPECT_NEAR(spread({1, 2, 3, 4, 5}), 1.4826, 1e-12);
}

}  // namespace vantage::paired_race_test
