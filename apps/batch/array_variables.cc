#include "apps/batch/array_variables.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdlib>
#include <string_view>

#include "engine/error.h"

namespace vantage::apps {
namespace {

/// What an engine tells a task. Null: it does not.
struct ArrayEngine {
  const char* index;  ///< the variable that tasks of arrays have
  const char* first;  ///< the smallest index; null: 0
  const char* last;   ///< the largest one
  const char* count;  ///< the number of tasks
};

constexpr const char* kTasks = "VANTAGE_BATCH_TASKS";
constexpr std::array<ArrayEngine, 5> kEngines = {
    {{"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", nullptr, "SLURM_ARRAY_TASK_COUNT"},
     {"AWS_BATCH_JOB_ARRAY_INDEX", nullptr, nullptr, "AWS_BATCH_JOB_ARRAY_SIZE"},
     {"JOB_COMPLETION_INDEX", nullptr, nullptr, nullptr},
     {"SGE_TASK_ID", "SGE_TASK_FIRST", "SGE_TASK_LAST", nullptr},
     {"PBS_ARRAY_INDEX", nullptr, nullptr, nullptr}}};

std::optional<int> number_in(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && number >= 0
             ? std::optional(number)
             : std::nullopt;
}

/// Empty where it is not set; grid engines say "undefined" outside arrays.
std::optional<int> variable(const char* name) {
  const char* const text = name == nullptr ? nullptr : std::getenv(name);
  if (text == nullptr || *text == '\0' || std::string_view(text) == "undefined") {
    return std::nullopt;
  }
  const std::optional<int> number = number_in(text);
  if (!number) {
    throw UsageError(fmt::format("{} is '{}', expected a whole number", name, quotable(text)));
  }
  return number;
}

}  // namespace

std::optional<ArrayTask> to_array_task(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) {
    return std::nullopt;
  }
  const auto index = number_in(std::string_view(text).substr(0, slash));
  const auto count = number_in(std::string_view(text).substr(slash + 1));
  return index && count && *index >= 1 && *index <= *count
             ? std::optional(ArrayTask{*index, *count})
             : std::nullopt;
}

std::optional<ArrayTask> task_of_environment() {
  for (const ArrayEngine& engine : kEngines) {
    const std::optional<int> index = variable(engine.index);
    if (!index) {
      continue;
    }
    const int first = variable(engine.first).value_or(0);
    std::optional<int> count = variable(kTasks);
    if (!count) {
      count = variable(engine.count);
    }
    if (const auto last = variable(engine.last); !count && last) {
      count = *last - first + 1;
    }
    if (!count) {
      throw UsageError(fmt::format("{} says which task this is, but not of how many; expected {}=N",
                                   engine.index, kTasks));
    }
    const ArrayTask task{*index - first + 1, *count};
    if (task.index < 1 || task.index > task.count) {
      throw UsageError(
          fmt::format("{} is {}, expected one of {} tasks", engine.index, *index, task.count));
    }
    return task;
  }
  return std::nullopt;
}

}  // namespace vantage::apps
