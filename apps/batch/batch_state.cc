#include "apps/batch/batch_state.h"

#include <fmt/format.h>

#include <string_view>

#include "engine/error.h"
#include "engine/io/files/json_text.h"

namespace vantage::apps {
namespace {

constexpr std::uint64_t kMaxBytes = 1ULL << 30;

std::string key_of_plan() { return std::string(BatchState::kPrefix) + "plan.json"; }

std::string key_of(std::string_view folder, const std::string& name) {
  return fmt::format("{}{}/{}.json", BatchState::kPrefix, folder, name);
}

std::string text_of(const std::vector<ItemResult>& results) {
  SettingValue values = SettingValue::array();
  for (const ItemResult& result : results) {
    values.push_back(to_values(result));
  }
  return values.dump(-1, ' ', false, SettingValue::error_handler_t::replace);
}

}  // namespace

std::optional<std::string> BatchState::read(const std::string& key) {
  if (!store_.info(key)) {
    return std::nullopt;
  }
  const ObjectPart part = store_.read(key, std::nullopt, "", kMaxBytes);
  return std::string(part.bytes.begin(), part.bytes.end());
}

std::optional<BatchPlan> BatchState::read_plan() {
  const std::optional<std::string> text = read(key_of_plan());
  return text ? std::optional(plan_from_json(*text, key_of_plan())) : std::nullopt;
}

BatchPlan BatchState::keep_plan(const BatchPlan& plan) {
  (void)store_.put_text(key_of_plan(), to_json(plan), {.if_absent = true});
  return *read_plan();
}

bool BatchState::excludes() {
  // Another content: a put that is repeated may meet its own.
  const std::string key = std::string(kPrefix) + "probe";
  (void)store_.put_text(key, "is there");
  return !store_.put_text(key, "is created", {.if_absent = true});
}

std::set<std::string> BatchState::done() {
  constexpr std::string_view kExtension = ".json";
  const std::string folder = std::string(kPrefix) + "done/";
  std::set<std::string> names;
  store_.list(folder, false, [&](const ListedObject& object) {
    if (object.key.ends_with(kExtension)) {
      names.insert(
          object.key.substr(folder.size(), object.key.size() - folder.size() - kExtension.size()));
    }
    return true;
  });
  return names;
}

bool BatchState::is_done(const std::string& name) {
  return store_.info(key_of("done", name)).has_value();
}

std::vector<ItemResult> BatchState::results(const std::string& name) {
  std::vector<ItemResult> results;
  std::string key = key_of("done", name);
  std::optional<std::string> text = read(key);
  if (!text) {
    key = key_of("progress", name);
    text = read(key);
  }
  if (!text) {
    return results;
  }
  try {
    for (const SettingValue& values : parse_json(*text, key)) {
      results.push_back(result_from_values(values));
    }
  } catch (const SettingValue::exception& error) {
    throw Error(fmt::format("{}: is damaged, expected results of items ({})", key, error.what()));
  }
  return results;
}

void BatchState::keep_progress(const std::string& name, const std::vector<ItemResult>& results) {
  (void)store_.put_text(key_of("progress", name), text_of(results));
}

bool BatchState::finish(const std::string& name, const std::vector<ItemResult>& results) {
  const bool is_first =
      store_.put_text(key_of("done", name), text_of(results), {.if_absent = true}).has_value();
  store_.remove(key_of("progress", name));
  return is_first;
}

void BatchState::reopen(const std::string& name) { store_.remove(key_of("done", name)); }

}  // namespace vantage::apps
