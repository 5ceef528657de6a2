#pragma once

#include <optional>
#include <string>

#include "apps/eval/folder_scores.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// The server that a submission is for.
enum class SubmissionKind { kKitti2015, kKitti2012, kMiddlebury, kEth3d };

struct SubmissionOptions {
  std::optional<SubmissionKind> kind;
  std::string folder;
  std::string method = "Vantage";  ///< part of Middlebury's file names
  std::optional<double> seconds;   ///< per map
  std::string times;               ///< a report of a run, for `seconds`
};

/// --submission and its options, in the present group.
void add_submission_settings(Settings& settings, SubmissionOptions& options);
/// Throws UsageError where options are missing or nothing reads them.
void check_submission(const SubmissionOptions& options, const Settings& settings);

/// Writes the maps of a data set's scenes (in the folder `data`) as the server wants them, and the
/// times. Returns one line for people. Throws Error for a file that exists, and if the report has
/// no time.
std::string write_submission(const SubmissionOptions& options, const std::string& data,
                             const BenchmarkFolder& folder, const ReadMap& read);

}  // namespace vantage::apps
