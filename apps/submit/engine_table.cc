#include "apps/submit/engine_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "engine/error.h"

namespace vantage::apps {
namespace {

const std::array kEngines = {
    EngineEntry{.engine = BatchEngine::kSlurm,
                .name = "slurm",
                .program = "sbatch",
                .options = {"tasks", "concurrent", "time", "drain-time", "retries", "shards",
                            "partition", "account", "sbatch-option"},
                .write = slurm_submission},
    EngineEntry{.engine = BatchEngine::kSge,
                .name = "sge",
                .program = "qsub",
                .max_tasks = 75000,  // `max_aj_tasks`
                .options = {"tasks", "concurrent", "time", "drain-time", "retries", "queue",
                            "parallel-environment", "memory-resource", "qsub-option"},
                .write = sge_submission},
    EngineEntry{.engine = BatchEngine::kKubernetes,
                .name = "kubernetes",
                .program = "kubectl",
                .shares_files = false,
                .options = {"tasks", "concurrent", "time", "drain-time", "retries", "image",
                            "service-account", "volume-claim"},
                .required = {"image"},
                .write = kubernetes_submission},
    // It kills a task 30 seconds after the signal to end.
    EngineEntry{
        .engine = BatchEngine::kAwsBatch,
        .name = "aws-batch",
        .program = "aws",
        .shares_files = false,
        .max_tasks = 10000,
        .max_retries = 9,
        .drain_s = 30,
        .options = {"tasks", "time", "retries", "queue", "image", "job-role", "execution-role"},
        .required = {"queue", "image"},
        .write = aws_batch_submission},
    EngineEntry{.engine = BatchEngine::kLocal,
                .name = "local",
                .program = "",
                .max_tasks = 1024,
                .options = {"concurrent", "drain-time"},
                .write = local_submission}};

}  // namespace

std::span<const EngineEntry> engines() { return kEngines; }

const EngineEntry& engine_entry(BatchEngine engine) {
  return kEngines.at(static_cast<std::size_t>(engine));
}

void check_engine_options(const Settings& settings, const EngineEntry& engine) {
  for (const EngineEntry& other : kEngines) {
    for (const std::string_view option : other.options) {
      if (std::ranges::count(engine.options, option) == 0 && settings.is_set(std::string(option))) {
        throw UsageError(fmt::format("--{} has no effect with --engine {}", option, engine.name));
      }
    }
  }
  for (const std::string_view option : engine.required) {
    if (!settings.is_set(std::string(option))) {
      throw UsageError(
          fmt::format("--{} is missing, expected with --engine {}", option, engine.name));
    }
  }
}

}  // namespace vantage::apps
