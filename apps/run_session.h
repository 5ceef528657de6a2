#pragma once

#include <memory>
#include <optional>
#include <string>

#include "apps/applied_tuning.h"
#include "apps/run_report.h"
#include "apps/run_settings.h"
#include "engine/rectification/rectifier.h"
#include "engine/sequence/memory_plan.h"
#include "engine/sequence/run_journal.h"
#include "engine/sequence/sequence_runner.h"

namespace vantage::apps {

/// A run whose input has been opened and examined; nothing is written yet.
struct RunSession {
  std::unique_ptr<PairSource> pairs;
  std::optional<Rectifier> rectifier;   ///< if a calibration must be applied
  std::optional<MapCamera> map_camera;  ///< of outputs in metres
  std::optional<FramePoses> poses;
  PairShape shape;  ///< of the first pair that could be read
  FrameSelection selection;
  RunIdentity identity;
  AppliedTuning tuning;
  ExecutionOptions execution;  ///< of the run: as the user gave it, then as tuned
  MemoryPlan memory;
  std::string executor;  ///< "2 threads (tbb)"

  /// Rectifies a pair in place if a calibration must be applied.
  void rectify(FramePair& pair, Execution& pool) const;
  /// The task of the run; `shots` if the options need them.
  [[nodiscard]] SequenceRun run(const RunJob& job, const ShotTable* shots) const;
  /// Names this process's part of the run, for the journal: "all", "2-of-7", "frames-100-199".
  [[nodiscard]] static std::string part_name(const RunJob& job);
};

/// The pairs of --frames, which counts the frames of the input; empty: all.
std::optional<FrameRange> selected_pairs(const RunJob& job, const PairSource& pairs);

/// Opens the input of `job`, which is complete(), and fills in what follows from it: the range of
/// disparities where it is automatic, the frame rate, the plan. Throws Error, UsageError where a
/// result would replace an input.
RunSession open_run(RunJob& job, const Settings& settings, RunReport& report);

/// The plan in several lines of text.
std::string describe_plan(const RunJob& job, const RunSession& session);

/// Reads the settings of the run in `folder` into `job` and tells `files` what the run writes
/// there.
RunIdentity read_run(const std::string& folder, RunJob& job, FileChecks& files);

}  // namespace vantage::apps
