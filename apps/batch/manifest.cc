#include "apps/batch/manifest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "apps/run/run_settings.h"
#include "engine/error.h"
#include "engine/io/files/csv_records.h"
#include "engine/io/files/encoded_text.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/json_text.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/video/streams/stream_input.h"
#include "engine/quoted_text.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOutput = "output";
/// Of items although they change how work is done, not what is made.
constexpr std::array<std::string_view, 2> kOfItems = {"frames", "keep-going"};

/// What the columns of a manifest may be, and what their values mean.
class ItemOptions {
 public:
  ItemOptions() { add_run_settings(settings_, job_); }

  /// Throws UsageError beginning with `place` where `name` is no option of an item.
  [[nodiscard]] const Setting& require(const std::string& name, const std::string& place) const {
    try {
      const Setting& setting = settings_.require(name, name);
      const bool is_of_item = setting.changes_results || setting.path == PathRole::kInput ||
                              std::ranges::find(kOfItems, name) != kOfItems.end();
      if (!is_of_item) {
        throw UsageError(fmt::format(
            "'{}' is no option of an item, expected it on the command line, for all", name));
      }
      return setting;
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("{}: {}", place, error.what()));
    }
  }

 private:
  RunJob job_;
  Settings settings_{"run", ""};
};

/// Adds the value of a column to an item. `place` names file and line.
void take(const Setting& setting, const SettingValue& value, const fs::path& folder,
          const std::string& place, ManifestItem& item) {
  const auto located = [&](const SettingValue& path) -> SettingValue {
    return path.is_string() && setting.path == PathRole::kInput &&
                   !is_stream_name(path.get<std::string>())
               ? SettingValue(stored_name(joined_path(folder, path.get<std::string>()).string()))
               : path;
  };
  SettingValue kept = located(value);
  if (value.is_array()) {
    kept = SettingValue::array();
    for (const SettingValue& member : value) {
      kept.push_back(located(member));
    }
  }
  if (item.options.contains(setting.name)) {
    throw Error(fmt::format("{}: {} is given twice", place, setting.name));
  }
  item.options[setting.name] = std::move(kept);
}

/// "a/b": below the folder of the batch, and not among its own files.
std::string checked_output(const std::string& text, const std::string& place) {
  const fs::path path = fs::path(text).lexically_normal();
  const bool is_below = !text.empty() && path.is_relative() && path != "." &&
                        std::ranges::none_of(path, [](const fs::path& part) {
                          return part.string().starts_with('.');
                        });
  if (!is_below || stored_name(text) != text || quotable(text) != text) {
    throw Error(fmt::format(
        "{}: the output is '{}', expected a folder below that of the batch such as films/a, "
        "without names that begin with a dot",
        place, quotable(text)));
  }
  std::string folder = path.string();
  return folder.ends_with('/') ? folder.substr(0, folder.size() - 1) : folder;
}

std::string place_of(const fs::path& file, int line) {
  return fmt::format("{} line {}", file.string(), line);
}

std::vector<ManifestItem> parse_csv(std::string_view text, const fs::path& file,
                                    const ItemOptions& options) {
  const std::string_view heading = text.substr(0, text.find('\n'));
  const char separator = heading.find('\t') != std::string_view::npos  ? '\t'
                         : heading.find(';') != std::string_view::npos ? ';'
                                                                       : ',';
  CsvRecords records(text, file.string(), separator);
  std::vector<std::string> names;
  records.next(names);
  if (std::ranges::find(names, kOutput) == names.end()) {
    records.fail(records.record_line(),
                 fmt::format("the columns are {}, expected a heading with output, and inputs such "
                             "as left and right, or stereo",
                             quotable(fmt::format("{}", fmt::join(names, ", ")))));
  }
  std::vector<const Setting*> columns;  // null: the output
  for (const std::string& name : names) {
    columns.push_back(name == kOutput ? nullptr : &options.require(name, place_of(file, 1)));
  }
  std::vector<ManifestItem> items;
  std::vector<std::string> fields;
  while (records.next(fields)) {
    const int line = records.record_line();
    if (fields.size() != names.size()) {
      records.fail(line, fmt::format("{} fields, expected {} as in the heading", fields.size(),
                                     names.size()));
    }
    ManifestItem item{.line = line};
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (columns[i] == nullptr) {
        item.output = checked_output(fields[i], place_of(file, line));
      } else if (!fields[i].empty()) {
        take(*columns[i], fields[i], file.parent_path(), place_of(file, line), item);
      }
    }
    items.push_back(std::move(item));
  }
  return items;
}

ManifestItem parse_object(std::string_view text, int line, const fs::path& file,
                          const ItemOptions& options) {
  const std::string place = place_of(file, line);
  const SettingValue object = parse_json(text, place);
  if (!object.is_object() || !object.contains(kOutput) || !object[kOutput].is_string()) {
    throw Error(fmt::format("{}: expected an object with a text output", place));
  }
  ManifestItem item{.line = line,
                    .output = checked_output(object[kOutput].get<std::string>(), place)};
  for (const auto& [name, value] : object.items()) {
    if (name != kOutput && !value.is_null()) {
      take(options.require(name, place), value, file.parent_path(), place, item);
    }
  }
  return item;
}

std::vector<ManifestItem> parse_json_lines(std::string_view text, const fs::path& file,
                                           const ItemOptions& options) {
  std::vector<ManifestItem> items;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view object = text.substr(0, end);
    if (object.find_first_not_of(" \t\r") != std::string_view::npos) {
      items.push_back(parse_object(object, line, file, options));
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return items;
}

/// Results of two items must not share a folder.
void require_different_outputs(const std::vector<ManifestItem>& items, const fs::path& file) {
  std::map<std::string_view, int> line_of;
  for (const ManifestItem& item : items) {
    const auto [known, is_new] = line_of.emplace(item.output, item.line);
    if (!is_new) {
      throw Error(fmt::format("{}: the output '{}' is that of line {}, too",
                              place_of(file, item.line), item.output, known->second));
    }
  }
  for (const ManifestItem& item : items) {
    for (std::size_t slash = item.output.find('/'); slash != std::string::npos;
         slash = item.output.find('/', slash + 1)) {
      if (const auto outer = line_of.find(std::string_view(item.output).substr(0, slash));
          outer != line_of.end()) {
        throw Error(fmt::format("{}: the output '{}' is inside that of line {}",
                                place_of(file, item.line), item.output, outer->second));
      }
    }
  }
}

}  // namespace

std::vector<ManifestItem> read_manifest(const fs::path& file) {
  const std::string text = read_file_text(file);
  const fs::path absolute = absolute_path(file);
  const ItemOptions options;
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  std::vector<ManifestItem> items = start != std::string::npos && text[start] == '{'
                                        ? parse_json_lines(text, absolute, options)
                                        : parse_csv(text, absolute, options);
  if (items.empty()) {
    throw Error(fmt::format("{}: holds no items, expected a line for each", file.string()));
  }
  require_different_outputs(items, absolute);
  return items;
}

}  // namespace vantage::apps
