#include "engine/sequence/pair_list.h"

#include <fmt/format.h>

#include <string>

#include "engine/error.h"
#include "engine/io/csv_records.h"
#include "engine/io/file_bytes.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::vector<ListedPair> parse_pair_list(std::string_view text, const fs::path& file) {
  CsvRecords records(text, file.string());
  std::vector<ListedPair> pairs;
  std::vector<std::string> fields;
  for (bool is_first = true; records.next(fields); is_first = false) {
    if (fields.size() != 2) {
      records.fail(records.record_line(),
                   fmt::format("{} field{}, expected two: left,right", fields.size(),
                               fields.size() == 1 ? "" : "s"));
    }
    if (is_first && equals_ignoring_case(fields[0], "left") &&
        equals_ignoring_case(fields[1], "right")) {
      continue;
    }
    if (fields[0].empty() || fields[1].empty()) {
      records.fail(records.record_line(),
                   fmt::format("the {} name is empty, expected an image file",
                               fields[0].empty() ? "left" : "right"));
    }
    pairs.push_back({fields[0], fields[1]});
  }
  if (pairs.empty()) {
    throw Error(fmt::format("{}: holds no pairs, expected lines left,right", file.string()));
  }
  return pairs;
}

std::vector<ListedPair> read_pair_list(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(file);
  return parse_pair_list({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
}

}  // namespace vantage
