#include "apps/batch/item_result.h"

#include <fmt/format.h>

namespace vantage::apps {

SettingValue to_values(const ItemResult& result) {
  SettingValue values = {{"item", result.item},
                         {"status", result.failed        ? "failed"
                                    : result.skipped > 0 ? "frames skipped"
                                                         : "done"},
                         {"problem", result.problem},
                         {"frames", result.frames},
                         {"skipped", result.skipped},
                         {"attempts", result.attempts},
                         {"seconds", result.seconds},
                         {"core_seconds", result.core_seconds}};
  if (!result.files.empty()) {
    values["files"] = SettingValue::array();
    for (const FileRecord& file : result.files) {
      values["files"].push_back({{"name", file.name},
                                 {"bytes", file.content.bytes},
                                 {"crc32", fmt::format("{:08x}", file.content.crc32)}});
    }
  }
  if (!result.command.empty()) {
    values["command"] = result.command;
  }
  return values;
}

ItemResult result_from_values(const SettingValue& values) {
  ItemResult result;
  result.item = values.at("item").get<int>();
  result.failed = values.at("status") == "failed";
  result.problem = values.at("problem").get<std::string>();
  result.frames = values.at("frames").get<int>();
  result.skipped = values.at("skipped").get<int>();
  result.attempts = values.at("attempts").get<int>();
  result.seconds = values.at("seconds").get<double>();
  result.core_seconds = values.at("core_seconds").get<double>();
  for (const SettingValue& file : values.value("files", SettingValue::array())) {
    FileContent content;
    content.bytes = file.at("bytes").get<std::uint64_t>();
    content.crc32 =
        static_cast<std::uint32_t>(std::stoul(file.at("crc32").get<std::string>(), nullptr, 16));
    result.files.push_back({file.at("name").get<std::string>(), content});
  }
  result.command = values.value("command", "");
  return result;
}

}  // namespace vantage::apps
