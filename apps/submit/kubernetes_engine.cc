#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/submit/engine_table.h"

namespace vantage::apps {
namespace {

// A pod whose node makes room for others or goes away is replaced without end; one that fails
// otherwise (exit code 75 too: not finished) until backoffLimitPerIndex.
constexpr const char* kTemplate =
    R"YAML(# Pod i does share i + 1 of {tasks} of a manifest. Written by 'vantage submit'.
apiVersion: batch/v1
kind: Job
metadata:
  name: {name}
spec:
  completionMode: Indexed
  completions: {tasks}
  parallelism: {concurrent}
  backoffLimitPerIndex: {retries}
  maxFailedIndexes: {tasks}
  podFailurePolicy:
    rules:  # the first that fits counts
      - action: Ignore  # the node was drained, preempted or lost: again, and not counted
        onPodConditions:
          - type: DisruptionTarget
            status: "True"
      - action: FailJob  # wrong usage, which all pods would find
        onExitCodes:
          containerName: vantage
          operator: In
          values: [2]
      - action: FailIndex  # done, but for items that failed for good
        onExitCodes:
          containerName: vantage
          operator: In
          values: [3]
  template:
    spec:
      restartPolicy: Never
      terminationGracePeriodSeconds: {drain}
{pod}      containers:
        - name: vantage
          image: {image}
          command:
{command}          env:
            - name: VANTAGE_BATCH_TASKS
              value: "{tasks}"
          resources:
            requests:
              cpu: {cores}
              memory: {memory}Mi
            limits:
              memory: {memory}Mi
{volumes})YAML";

/// A string in double quotes, as in JSON.
std::string yaml_text(const std::string& text) { return nlohmann::json(text).dump(); }

/// A word of the command, where Kubernetes replaces $(NAME).
std::string yaml_word(const std::string& word) {
  std::string text;
  for (std::size_t place = 0; place < word.size(); ++place) {
    text += word.compare(place, 2, "$(") == 0 ? "$$" : word.substr(place, 1);
  }
  return yaml_text(text);
}

/// Lines of the pod that it need not have.
std::string pod_lines(const ArrayJob& job, const SubmitOptions& options) {
  std::string text;
  if (job.time_limit_s) {
    text += fmt::format("      activeDeadlineSeconds: {}\n", *job.time_limit_s);
  }
  if (!options.service_account.empty()) {
    text += fmt::format("      serviceAccountName: {}\n", yaml_text(options.service_account));
  }
  return text;
}

/// Claims: where the container sees them, and which they are.
std::string volumes(const std::vector<std::string>& volume_claims) {
  std::string mounts;
  std::string claims;
  for (std::size_t i = 0; i < volume_claims.size(); ++i) {
    const std::size_t colon = volume_claims[i].find(':');
    mounts += fmt::format("            - name: claim-{}\n              mountPath: {}\n", i + 1,
                          yaml_text(volume_claims[i].substr(colon + 1)));
    claims += fmt::format(
        "        - name: claim-{}\n          persistentVolumeClaim:\n            claimName: {}\n",
        i + 1, yaml_text(volume_claims[i].substr(0, colon)));
  }
  return mounts.empty() ? "" : "          volumeMounts:\n" + mounts + "      volumes:\n" + claims;
}

}  // namespace

Submission kubernetes_submission(const ArrayJob& job, const SubmitOptions& options) {
  std::string command;
  for (const std::string& word : job.command) {
    command += fmt::format("            - {}\n", yaml_word(word));
  }
  const std::string text = fmt::format(
      kTemplate, fmt::arg("name", job.name), fmt::arg("tasks", job.tasks),
      fmt::arg("concurrent", job.concurrent.value_or(job.tasks)), fmt::arg("retries", job.retries),
      fmt::arg("drain", job.drain_s), fmt::arg("pod", pod_lines(job, options)),
      fmt::arg("image", yaml_text(options.image)), fmt::arg("command", command),
      fmt::arg("cores", *job.cores), fmt::arg("memory", mebibytes(*job.memory_bytes)),
      fmt::arg("volumes", volumes(options.volume_claims)));
  return {.files = {{"job.yaml", text}},
          .commands = {{"kubectl", "create", "-f", (job.folder / "job.yaml").string()}}};
}

}  // namespace vantage::apps
