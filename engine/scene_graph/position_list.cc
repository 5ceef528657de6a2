#include "engine/scene_graph/position_list.h"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "engine/error.h"
#include "engine/io/files/csv_records.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/files/text_lines.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::vector<SceneImage> parse_position_list(std::string_view text, const fs::path& file) {
  CsvRecords records(text, file.string());
  std::vector<SceneImage> images;
  std::vector<std::string> fields;
  for (bool is_first = true; records.next(fields); is_first = false) {
    if (fields.size() != 3) {
      records.fail(records.record_line(),
                   fmt::format("{} field{}, expected three: image,x,y", fields.size(),
                               fields.size() == 1 ? "" : "s"));
    }
    if (is_first && equals_ignoring_case(fields[0], "image") &&
        equals_ignoring_case(fields[1], "x") && equals_ignoring_case(fields[2], "y")) {
      continue;
    }
    const auto coordinate = [&](std::size_t field) {
      const std::optional<double> value = finite_number(fields[field]);
      if (!value) {
        records.fail(records.record_line(),
                     fmt::format("{} is '{}', expected a finite number", field == 1 ? "x" : "y",
                                 quotable(fields[field])));
      }
      return *value;
    };
    if (fields[0].empty()) {
      records.fail(records.record_line(), "the name is empty, expected an image file");
    }
    images.push_back({.file = joined_path(file.parent_path(), fields[0]),
                      .position = {.x = coordinate(1), .y = coordinate(2)}});
  }
  if (images.empty()) {
    throw Error(fmt::format("{}: holds no images, expected lines image,x,y", file.string()));
  }
  return images;
}

std::vector<SceneImage> read_position_list(const fs::path& file) {
  return parse_position_list(read_file_text(file), file);
}

}  // namespace vantage
