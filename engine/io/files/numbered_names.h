#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace vantage {

/// Whether `letter` is 0 to 9, in any locale.
constexpr bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }

/// The last number in a file name without its extension ("left_0012.png": 12); empty when there is
/// none or it has more than 18 digits.
std::optional<long long> frame_number(const std::filesystem::path& file);

/// A file name with one number in it.
struct NumberPattern {
  std::string prefix;
  int digits = 1;  ///< minimum number of digits, padded with zeros
  std::string suffix;

  [[nodiscard]] std::string name(int number) const;
  /// A shell pattern that matches all names of this pattern.
  [[nodiscard]] std::string wildcard() const { return prefix + "*" + suffix; }
  /// The number in `name`, if it has this pattern.
  [[nodiscard]] std::optional<int> number_in(const std::string& name) const;
};

/// Parses "left_%06d.png"; "%%" is a percent sign. Throws UsageError starting with `spec` when
/// there is not exactly one %d or %0Nd (N in 1..9).
NumberPattern parse_number_pattern(const std::string& name, const std::string& spec);

/// Natural order of names: numbers inside them by value (frame2 before frame10), the rest character
/// by character. A strict total order of different paths.
bool comes_before_naturally(const std::filesystem::path& left, const std::filesystem::path& right);

}  // namespace vantage
