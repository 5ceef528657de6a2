#include "engine/sequence/pairs/pair_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/csv_records.h"
#include "engine/io/files/encoded_text.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/video/image_sequence.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> kColumns = {
    "left", "right", "name", "calibration", "min-disparity", "max-disparity"};
enum Column : std::size_t { kLeft, kRight, kName, kCalibration, kMinDisparity, kMaxDisparity };
constexpr std::size_t kMaxNameLength = 200;

/// Where a list has its columns.
using Places = std::array<std::optional<std::size_t>, kColumns.size()>;

/// Of a list without a heading.
constexpr Places kWithoutHeading = {0, 1};

bool is_heading(const std::vector<std::string>& fields) {
  const auto has = [&](std::string_view column) {
    return std::ranges::any_of(
        fields, [&](const std::string& field) { return equals_ignoring_case(field, column); });
  };
  return has("left") && has("right");
}

/// The first of these by which the first record is a pair or a heading, else one that it has.
char separator_of(std::string_view text, const fs::path& file) {
  std::optional<char> seen;
  for (const char separator : {',', ';', '\t', ' '}) {
    try {
      std::vector<std::string> fields;
      CsvRecords(text, file.string(), separator).next(fields);
      if (fields.size() == 2 || is_heading(fields)) {
        return separator;
      }
      if (!seen && fields.size() > 1 && separator != ' ') {
        seen = separator;
      }
    } catch (const Error&) {
      continue;  // of a quote, said later
    }
  }
  return seen.value_or(',');
}

Places places_of(const std::vector<std::string>& fields, const CsvRecords& records) {
  Places places;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto* known = std::ranges::find_if(
        kColumns, [&](std::string_view name) { return equals_ignoring_case(fields[i], name); });
    if (known == kColumns.end()) {
      records.fail(records.record_line(),
                   fmt::format("the column '{}' is not known, expected {}", quotable(fields[i]),
                               fmt::join(kColumns, ", ")));
    }
    auto& place = places.at(static_cast<std::size_t>(known - kColumns.begin()));
    if (place) {
      records.fail(records.record_line(), fmt::format("the column {} is given twice", *known));
    }
    place = i;
  }
  if (places[kMinDisparity].has_value() != places[kMaxDisparity].has_value()) {
    records.fail(records.record_line(),
                 "one of the columns min-disparity and max-disparity is missing, expected both or "
                 "none");
  }
  return places;
}

std::string expected_fields(std::size_t columns, const std::vector<std::string>& fields) {
  if (columns != 2) {
    return fmt::format("{} as in the heading", columns);
  }
  return fields.size() > 2 ? "two: left,right; further columns need a heading" : "two: left,right";
}

/// The files of a pair are DIR/disparity/NAME.pfm and so on, which the journal names in UTF-8.
void require_file_name(const std::string& name, const CsvRecords& records) {
  const bool is_plain =
      name.size() <= kMaxNameLength && !name.starts_with('.') && stored_name(name) == name &&
      std::ranges::none_of(
          name, [](unsigned char c) { return c < 0x20 || c == 0x7f || c == '/' || c == '\\'; });
  if (!is_plain) {
    records.fail(records.record_line(),
                 fmt::format("the name is '{}', expected one of a file without folder and "
                             "extension, of at most {} bytes of UTF-8",
                             quotable(name), kMaxNameLength));
  }
}

std::optional<DisparityRange> range_of(const std::string& min, const std::string& max,
                                       const CsvRecords& records) {
  if (min.empty() && max.empty()) {
    return std::nullopt;
  }
  const auto number_of = [](const std::string& text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value)
                                                                    : std::nullopt;
  };
  const std::optional<int> from = number_of(min);
  const std::optional<int> to = number_of(max);
  if (!from || !to || *from > *to) {
    records.fail(records.record_line(),
                 fmt::format("the disparities are '{}' to '{}', expected whole numbers MIN <= MAX, "
                             "or both empty",
                             quotable(min), quotable(max)));
  }
  return DisparityRange{*from, *to};
}

/// Names of results must differ, also from the numbers that name those of pairs without a name.
void require_different_names(const std::vector<ListedPair>& pairs, const std::vector<int>& lines,
                             const CsvRecords& records) {
  const bool has_numbers =
      std::ranges::any_of(pairs, [](const ListedPair& pair) { return pair.details.name.empty(); });
  std::map<std::string_view, int> line_of;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::string& name = pairs[i].details.name;
    if (name.empty()) {
      continue;
    }
    const auto [known, is_new] = line_of.emplace(name, lines[i]);
    if (!is_new) {
      records.fail(lines[i], fmt::format("the name '{}' is that of line {}, too, expected "
                                         "different names",
                                         quotable(name), known->second));
    }
    const bool is_number =
        name.size() >= 6 && std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
    if (is_number && has_numbers) {
      records.fail(lines[i], fmt::format("the name '{}' looks like the number of a pair without a "
                                         "name, expected names for all pairs, or another one",
                                         quotable(name)));
    }
  }
}

}  // namespace

std::vector<ListedPair> parse_pair_list(std::string_view text, const fs::path& file) {
  CsvRecords records(text, file.string(), separator_of(text, file));
  std::vector<ListedPair> pairs;
  std::vector<int> lines;  // of the pairs
  std::vector<std::string> fields;
  Places places = kWithoutHeading;
  std::size_t columns = 2;
  for (bool is_first = true; records.next(fields); is_first = false) {
    if (is_first && is_heading(fields)) {
      places = places_of(fields, records);
      columns = fields.size();
      continue;
    }
    if (fields.size() != columns) {
      records.fail(records.record_line(),
                   fmt::format("{} field{}, expected {}", fields.size(),
                               fields.size() == 1 ? "" : "s", expected_fields(columns, fields)));
    }
    const auto field = [&](Column column) {
      return places.at(column) ? fields[*places.at(column)] : std::string();
    };
    for (const Column needed : {kLeft, kRight}) {
      if (field(needed).empty()) {
        records.fail(records.record_line(), fmt::format("the {} name is empty, expected an image "
                                                        "file",
                                                        kColumns.at(needed)));
      }
    }
    ListedPair pair{.left = field(kLeft), .right = field(kRight)};
    pair.details.name = field(kName);
    require_file_name(pair.details.name, records);
    if (const std::string calibration = field(kCalibration); !calibration.empty()) {
      pair.details.calibration = joined_path(file.parent_path(), calibration);
      pair.details.kitti_cameras = kitti_cameras_of(std::array{
          joined_path(file.parent_path(), pair.left), joined_path(file.parent_path(), pair.right)});
    }
    pair.details.disparities = range_of(field(kMinDisparity), field(kMaxDisparity), records);
    pairs.push_back(std::move(pair));
    lines.push_back(records.record_line());
  }
  if (pairs.empty()) {
    throw Error(fmt::format("{}: holds no pairs, expected lines left,right", file.string()));
  }
  require_different_names(pairs, lines, records);
  return pairs;
}

std::vector<ListedPair> read_pair_list(const fs::path& file, std::vector<std::string>* remarks) {
  std::vector<ListedPair> pairs = parse_pair_list(read_file_text(file), file);
  const auto is_present = [&](const fs::path& image) {
    return is_there(joined_path(file.parent_path(), image));
  };
  const auto may_be_image = [&](const fs::path& name) {
    return has_image_extension(name) || is_present(name);
  };
  const ListedPair first = pairs.front();
  if (!may_be_image(first.left) && !may_be_image(first.right) && first.details == PairDetails() &&
      std::any_of(pairs.begin() + 1, pairs.end(), [&](const ListedPair& pair) {
        return is_present(pair.left) && is_present(pair.right);
      })) {
    pairs.erase(pairs.begin());
    if (remarks != nullptr) {
      remarks->push_back(fmt::format(
          "{}: '{}' and '{}' are taken for a heading, there are no such "
          "files",
          file.string(), quotable(first.left.string()), quotable(first.right.string())));
    }
  }
  return pairs;
}

}  // namespace vantage
