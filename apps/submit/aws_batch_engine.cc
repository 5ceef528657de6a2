#include <fmt/format.h>

#include "apps/submit/engine_table.h"
#include "engine/options/setting_value.h"

namespace vantage::apps {
namespace {

SettingValue resource(const char* type, std::size_t value) {
  return {{"type", type}, {"value", fmt::format("{}", value)}};
}

SettingValue container_properties(const ArrayJob& job, const SubmitOptions& options) {
  SettingValue container = {
      {"image", options.image},
      {"command", job.command},
      {"resourceRequirements",
       {resource("VCPU", static_cast<std::size_t>(*job.cores)),
        resource("MEMORY", mebibytes(*job.memory_bytes))}},
      {"environment",
       {{{"name", "VANTAGE_BATCH_TASKS"}, {"value", fmt::format("{}", job.tasks)}}}}};
  if (!options.job_role.empty()) {
    container["jobRoleArn"] = options.job_role;
  }
  if (!options.execution_role.empty()) {
    container["executionRoleArn"] = options.execution_role;
  }
  return container;
}

/// The first condition that fits counts. A spot instance that went away, exit code 75 and all that
/// no condition names is tried again.
SettingValue retry_strategy(const ArrayJob& job) {
  return {{"attempts", job.retries + 1},
          {"evaluateOnExit",
           {{{"onStatusReason", "Host EC2*"}, {"action", "RETRY"}},
            {{"onExitCode", "2"}, {"action", "EXIT"}},
            {{"onExitCode", "3"}, {"action", "EXIT"}}}}};
}

std::vector<std::string> aws(const ArrayJob& job, const char* call, const char* file) {
  return {"aws", "batch", call, "--cli-input-json", "file://" + (job.folder / file).string()};
}

}  // namespace

Submission aws_batch_submission(const ArrayJob& job, const SubmitOptions& options) {
  SettingValue definition = {{"jobDefinitionName", job.name},
                             {"type", "container"},
                             {"containerProperties", container_properties(job, options)},
                             {"retryStrategy", retry_strategy(job)}};
  if (job.time_limit_s) {
    definition["timeout"] = {{"attemptDurationSeconds", *job.time_limit_s}};
  }
  SettingValue call = {
      {"jobName", job.name}, {"jobQueue", options.queue}, {"jobDefinition", job.name}};
  if (job.tasks > 1) {  // an array of one is refused
    call["arrayProperties"] = {{"size", job.tasks}};
  }
  return {.files = {{"job-definition.json", definition.dump(2) + "\n"},
                    {"submit-job.json", call.dump(2) + "\n"}},
          .commands = {aws(job, "register-job-definition", "job-definition.json"),
                       aws(job, "submit-job", "submit-job.json")}};
}

}  // namespace vantage::apps
