#include "engine/io/files/numbered_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>

#include "engine/error.h"

namespace vantage {
namespace {

/// Removes the digits at the start of `text` and returns them without leading zeros.
std::string_view take_number(std::string_view& text) {
  const auto digits =
      static_cast<std::size_t>(std::find_if_not(text.begin(), text.end(), is_digit) - text.begin());
  std::string_view number = text.substr(0, digits);
  text.remove_prefix(digits);
  number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
  return number;
}

}  // namespace

std::optional<long long> frame_number(const std::filesystem::path& file) {
  constexpr std::ptrdiff_t kMaxDigits = 18;
  const std::string stem = file.stem().string();
  const auto last = std::find_if(stem.rbegin(), stem.rend(), is_digit);
  const auto first = std::find_if_not(last, stem.rend(), is_digit);
  if (first == last || first - last > kMaxDigits) {
    return std::nullopt;
  }
  return std::stoll(std::string(first.base(), last.base()));
}

std::string NumberPattern::name(int number) const {
  return fmt::format("{}{:0{}}{}", prefix, number, digits, suffix);
}

std::optional<int> NumberPattern::number_in(const std::string& name) const {
  if (name.size() <= prefix.size() + suffix.size() || !name.starts_with(prefix) ||
      !name.ends_with(suffix)) {
    return std::nullopt;
  }
  int number = -1;
  const char* begin = name.data() + prefix.size();
  const char* end = name.data() + name.size() - suffix.size();
  const auto [stopped, error] = std::from_chars(begin, end, number);
  if (error != std::errc() || stopped != end || number < 0 || this->name(number) != name) {
    return std::nullopt;
  }
  return number;
}

NumberPattern parse_number_pattern(const std::string& name, const std::string& spec) {
  const auto fail = [&] {
    throw UsageError(
        fmt::format("{}: expected exactly one number like %d or %06d, in the file name", spec));
  };
  NumberPattern pattern;
  bool has_number = false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    std::string& target = has_number ? pattern.suffix : pattern.prefix;
    if (name[i] != '%') {
      target.push_back(name[i]);
      continue;
    }
    ++i;
    if (i < name.size() && name[i] == '%') {
      target.push_back('%');
      continue;
    }
    std::string width;
    while (i < name.size() && is_digit(name[i])) {
      width.push_back(name[i++]);
    }
    const bool valid_width =
        width.empty() || (width.size() == 2 && width[0] == '0' && width[1] != '0');
    if (i >= name.size() || name[i] != 'd' || has_number || !valid_width) {
      fail();
    }
    has_number = true;
    pattern.digits = width.empty() ? 1 : width[1] - '0';
  }
  if (!has_number) {
    fail();
  }
  return pattern;
}

bool comes_before_naturally(const std::filesystem::path& left, const std::filesystem::path& right) {
  std::string_view a = left.native();
  std::string_view b = right.native();
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view x = take_number(a);
      const std::string_view y = take_number(b);
      if (x.size() != y.size()) {
        return x.size() < y.size();
      }
      if (x != y) {
        return x < y;
      }
    } else if (a.front() != b.front()) {
      return a.front() < b.front();
    } else {
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) {
    return a.empty();
  }
  return left.native() < right.native();
}

}  // namespace vantage
