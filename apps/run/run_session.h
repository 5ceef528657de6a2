#pragma once

#include <string>

#include "apps/reports/run_report.h"
#include "apps/run/run_settings.h"
#include "apps/settings/applied_tuning.h"
#include "engine/jobs/sequence_session.h"
#include "engine/sequence/journal/run_journal.h"
#include "engine/sequence/memory_plan.h"
#include "engine/sequence/pairs/pair_cameras.h"

namespace vantage::apps {

/// A run whose input has been opened and examined; nothing is written yet.
struct RunSession : SequenceSession {
  RunIdentity identity;
  AppliedTuning tuning;
  ExecutionOptions execution;  ///< of the run: as the user gave it, then as tuned
  MemoryPlan memory;
  std::size_t free_bytes = 0;  ///< of memory, when the run was planned; 0: unknown
  std::string executor;        ///< "2 threads (tbb)"

  /// Names this process's part of the run, for the journal: "all", "2-of-7", "frames-100-199".
  [[nodiscard]] static std::string part_name(const RunJob& job);
};

/// Opens the input of `job`, which is complete(), and fills in what follows from it: the range of
/// disparities where it is automatic, the frame rate, the plan. Throws Error, UsageError where a
/// result would replace an input.
RunSession open_run(RunJob& job, const Settings& settings, RunReport& report);

/// " of 640x480 pixels"; of a list whose pairs may differ ", the first of 640x480 pixels".
std::string text_of_size(const RunJob& job, const RunSession& session);

/// The plan in several lines of text.
std::string describe_plan(const RunJob& job, const RunSession& session);

/// Reads the settings of the run in `folder` into `job` and tells `files` what the run writes
/// there.
RunIdentity read_run(const std::string& folder, RunJob& job, FileChecks& files);

}  // namespace vantage::apps
