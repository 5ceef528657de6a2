#pragma once

#include <chrono>
#include <list>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "engine/execution.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/tuning/tuning_pair.h"
#include "engine/tuning/tuning_subject.h"

namespace vantage {

/// What is timed, and which of its settings may be varied.
struct MatchSubjectOptions {
  MatchOptions match;          ///< disparities known
  ExecutionOptions execution;  ///< fields that are set stay fixed
  /// False if images are lower than those that plans are for: they cannot determine the height of
  /// bands.
  bool searches_bands = true;
};

/// One disparity map of a pair, without refinement: the part that depends on plans. Candidates are
/// the sizes of equal strips, bands and passes, without those that the cost model rates hopeless
/// and those that give the same plan as the incumbent.
///
/// Thread rule: one thread at a time.
class MatchSubject : public TuningSubject {
 public:
  /// `pair` must outlive the subject. Throws UsageError for invalid options, Error when no pixel
  /// has a candidate.
  MatchSubject(const MatchSubjectOptions& options, const TuningPair& pair);
  ~MatchSubject() override;

  std::vector<TunedSettings> candidates(const TuningCoordinate& coordinate,
                                        const TunedSettings& incumbent, bool finely) override;
  double expected_seconds(const TunedSettings& settings) override;
  double measure(const TunedSettings& settings) override;

 protected:
  /// Runs one setting; kept from measurement to measurement.
  struct Runner {
    Runner(const MatchOptions& match, const TunedSettings& tuned, const ExecutionOptions& options)
        : settings(tuned), execution(options), matcher(match, execution) {}
    TunedSettings settings;
    Execution execution;
    StereoMatcher matcher;
    DisparityMaps maps;
    bool is_warm = false;  ///< has run before
  };

  /// Runs once and returns the number of frames.
  virtual int work(Runner& runner);
  /// Values of a coordinate that this class does not know.
  virtual std::vector<int> more_values(const TuningCoordinate& coordinate,
                                       const TunedSettings& incumbent, bool finely) const;

  [[nodiscard]] const TuningPair& pair() const { return pair_; }
  [[nodiscard]] int threads_of(const TunedSettings& settings) const;

 private:
  /// State of one setting.
  struct Known {
    TunedSettings settings;
    scheduler::ChainPlan plan;
    double model_time = 0;                              ///< predicted by the cost model, in any
                                                        ///< unit
    std::optional<double> work_seconds = std::nullopt;  ///< of the last measurement, all frames
  };

  /// Plans the settings that have no plan yet. References stay valid.
  void plan_all(const std::vector<TunedSettings>& settings);
  Known& known(const TunedSettings& settings);
  Runner& runner_of(const TunedSettings& settings);
  [[nodiscard]] std::vector<int> values(const TuningCoordinate& coordinate,
                                        const TunedSettings& incumbent, bool finely);
  [[nodiscard]] bool is_fixed(const TuningCoordinate& coordinate) const;

  MatchSubjectOptions options_;
  const TuningPair& pair_;
  std::list<Known> known_;
  std::list<std::unique_ptr<Runner>> runners_;  ///< most recently used first
  scheduler::Machine machine_;
};

}  // namespace vantage
