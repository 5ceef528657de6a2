#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace vantage {

/// Frames per second as an exact fraction in lowest terms: 30000/1001 is not 29.97.
struct FrameRate {
  std::int64_t numerator = 25;   ///< 1..1000000
  std::int64_t denominator = 1;  ///< 1..1000000; the rate is at most 1000

  [[nodiscard]] double per_second() const {
    return static_cast<double>(numerator) / static_cast<double>(denominator);
  }
  friend bool operator==(const FrameRate&, const FrameRate&) = default;
};

/// Parses "25", "29.97" or "30000/1001"; empty for any other form or out of range. Decimals within
/// 5 millionths of N·1000/1001 (integer N) are read as that: 29.97 is 30000/1001.
std::optional<FrameRate> parse_frame_rate(std::string_view text);
/// rate / factor (factor ≥ 1); terms beyond the limits are rounded.
FrameRate slowed_down(FrameRate rate, int factor);
/// "25" or "30000/1001".
std::string to_string(FrameRate rate);

}  // namespace vantage
