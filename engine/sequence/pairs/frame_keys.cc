#include "engine/sequence/pairs/frame_keys.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <set>
#include <string_view>

#include "engine/io/files/numbered_names.h"

namespace vantage {
namespace {

struct Token {
  std::string text;
  bool is_number = false;

  friend bool operator==(const Token&, const Token&) = default;
};
using Name = std::vector<Token>;

/// Seconds since 1970 have so many digits, or almost.
constexpr std::size_t kSecondsDigits = 9;
constexpr std::size_t kFractionDigits = 9;
constexpr std::size_t kTimeDigits = 12;

bool is_letter(char c) {
  return (static_cast<unsigned char>(c) & 0x80U) != 0 ||
         (std::isalpha(static_cast<unsigned char>(c)) != 0);
}

std::size_t digits_at(std::string_view text, std::size_t place) {
  const std::size_t end = std::min(text.find_first_not_of("0123456789", place), text.size());
  return end > place ? end - place : 0;
}

/// Digits of the fraction behind the `whole` first ones and a point; 0: none. The point in
/// "shot1.0001" separates two numbers.
std::size_t fraction_digits(std::string_view text, std::size_t whole) {
  const bool has_point = whole < text.size() && text[whole] == '.';
  const std::size_t digits = has_point ? digits_at(text, whole + 1) : 0;
  return whole >= kSecondsDigits || digits >= 6 ? digits : 0;
}

Name name_of(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  std::string_view rest = stem;
  Name name;
  while (!rest.empty()) {
    std::size_t length = 1;
    if (is_digit(rest.front())) {
      length = digits_at(rest, 0);
      std::string_view whole = rest.substr(0, length);
      whole.remove_prefix(std::min(whole.find_first_not_of('0'), whole.size() - 1));
      std::string text(whole);
      if (const std::size_t digits = fraction_digits(rest, length); digits > 0) {
        text += "." + std::string(rest.substr(length + 1, digits));
        length += 1 + digits;
      }
      name.push_back({std::move(text), true});
    } else if (is_letter(rest.front())) {
      length = static_cast<std::size_t>(std::ranges::find_if_not(rest, is_letter) - rest.begin());
      name.push_back({std::string(rest.substr(0, length)), false});
    }
    rest.remove_prefix(length);
  }
  return name;
}

std::string lower(std::string word) {
  std::ranges::transform(word, word.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return word;
}

/// "leftImg" and "imgL" are both "img".
std::string without_side(const std::string& word) {
  const bool ends_with_capital = word.size() > 1 && (word.back() == 'L' || word.back() == 'R') &&
                                 word[word.size() - 2] >= 'a' && word[word.size() - 2] <= 'z';
  std::string text = lower(ends_with_capital ? word.substr(0, word.size() - 1) : word);
  for (const std::string_view side : {"left", "right"}) {
    if (text.starts_with(side)) {
      text.erase(0, side.size());
    } else if (text.ends_with(side)) {
      text.erase(text.size() - side.size());
    }
  }
  return text == "l" || text == "r" ? "" : text;
}

/// Of each place, counted from the front or the back, whether all names have the same there.
std::vector<bool> common_places(const std::vector<Name>& names, bool from_back) {
  const std::size_t places = std::ranges::min(names, {}, &Name::size).size();
  std::vector<bool> are_common;
  for (std::size_t place = 0; place < places; ++place) {
    const auto at = [&](const Name& name) -> const Token& {
      return name[from_back ? name.size() - 1 - place : place];
    };
    are_common.push_back(std::ranges::all_of(
        names, [&](const Name& name) { return at(name) == at(names.front()); }));
  }
  return are_common;
}

void keep_difference(std::vector<Name>& names) {
  const std::vector<bool> front = common_places(names, false);
  const std::vector<bool> back = common_places(names, true);
  for (Name& name : names) {
    Name kept;
    for (std::size_t place = 0; place < name.size(); ++place) {
      const std::size_t from_back = name.size() - 1 - place;
      if (!(place < front.size() && front[place]) &&
          !(from_back < back.size() && back[from_back])) {
        kept.push_back(std::move(name[place]));
      }
    }
    name = std::move(kept);
  }
}

void drop_sides(std::vector<Name>& names) {
  for (Name& name : names) {
    for (Token& token : name) {
      token.text = without_side(token.text);
    }
    std::erase_if(name, [](const Token& token) { return token.text.empty(); });
  }
}

/// Some write nanoseconds without the zeros in front: those that have nine digits tell.
void pad_nanoseconds(std::vector<std::string>& times) {
  const auto digits = [](const std::string& time) {
    const std::size_t point = time.find('.');
    return point == std::string::npos ? 0 : time.size() - point - 1;
  };
  if (digits(std::ranges::max(times, {}, digits)) != kFractionDigits) {
    return;
  }
  for (std::string& time : times) {
    if (const std::size_t own = digits(time); own > 0) {
      time.insert(time.size() - own, kFractionDigits - own, '0');
    }
  }
}

}  // namespace

FrameKeys frame_keys(const std::vector<std::filesystem::path>& files, NameReading reading) {
  std::vector<Name> names;
  std::ranges::transform(files, std::back_inserter(names), name_of);
  if (reading == NameReading::kWithoutSide) {
    drop_sides(names);
  } else if (reading == NameReading::kDifference) {
    keep_difference(names);
  }
  FrameKeys keys;
  for (const Name& name : names) {
    std::string text;
    for (const Token& token : name) {
      text += (text.empty() ? "" : " ") + lower(token.text);
    }
    keys.texts.push_back(std::move(text));
  }
  const std::set<std::string_view> different(keys.texts.begin(), keys.texts.end());
  if (different.size() < files.size() || different.contains("")) {
    return {};
  }
  if (std::ranges::all_of(names,
                          [](const Name& name) { return name.size() == 1 && name[0].is_number; })) {
    std::vector<std::string> numbers = keys.texts;
    keys.are_times = std::ranges::all_of(numbers, [](const std::string& number) {
      return number.size() >= kTimeDigits || number.find('.') != std::string::npos;
    });
    if (keys.are_times) {
      pad_nanoseconds(numbers);
    }
    for (const std::string& number : numbers) {
      double value = 0;
      std::from_chars(number.data(), number.data() + number.size(), value);
      keys.numbers.push_back(value);
    }
  }
  return keys;
}

}  // namespace vantage
