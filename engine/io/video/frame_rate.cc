#include "engine/io/video/frame_rate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <numeric>

namespace vantage {
namespace {

constexpr std::int64_t kLargestTerm = 1'000'000;
constexpr std::int64_t kLargestRate = 1000;
/// Relative: 29.97 and 23.976 are a millionth off 30000/1001 and 24000/1001.
constexpr double kDecimalTolerance = 5e-6;

/// An integer of 1 to 15 digits, without sign.
std::optional<std::int64_t> parse_digits(std::string_view text) {
  if (text.empty() || text.size() > 15 ||
      text.find_first_not_of("0123456789") != std::string_view::npos) {
    return std::nullopt;
  }
  std::int64_t value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

/// In lowest terms; empty when out of range.
std::optional<FrameRate> make_rate(std::int64_t numerator, std::int64_t denominator) {
  if (numerator < 1 || denominator < 1) {
    return std::nullopt;
  }
  const std::int64_t divisor = std::gcd(numerator, denominator);
  const FrameRate rate{numerator / divisor, denominator / divisor};
  if (rate.numerator > kLargestTerm || rate.denominator > kLargestTerm ||
      rate.numerator > kLargestRate * rate.denominator) {
    return std::nullopt;
  }
  return rate;
}

std::optional<FrameRate> parse_decimal(std::string_view whole, std::string_view fraction) {
  std::string digits(whole);
  digits += fraction;
  const std::optional<std::int64_t> value = parse_digits(digits);
  if (!value) {
    return std::nullopt;
  }
  std::int64_t scale = 1;
  for (std::size_t i = 0; i < fraction.size(); ++i) {
    scale *= 10;
  }
  const double rate = static_cast<double>(*value) / static_cast<double>(scale);
  const double television = std::round(rate * 1.001);
  if (*value % scale != 0 && television >= 1 &&
      std::abs(rate * 1.001 - television) <= kDecimalTolerance * television) {
    return make_rate(static_cast<std::int64_t>(television) * 1000, 1001);
  }
  return make_rate(*value, scale);
}

}  // namespace

std::optional<FrameRate> parse_frame_rate(std::string_view text) {
  if (const std::size_t slash = text.find('/'); slash != std::string_view::npos) {
    const auto numerator = parse_digits(text.substr(0, slash));
    const auto denominator = parse_digits(text.substr(slash + 1));
    return numerator && denominator ? make_rate(*numerator, *denominator) : std::nullopt;
  }
  const std::size_t point = text.find('.');
  return point == std::string_view::npos
             ? parse_decimal(text, "")
             : parse_decimal(text.substr(0, point), text.substr(point + 1));
}

FrameRate slowed_down(FrameRate rate, int factor) {
  const std::int64_t denominator = rate.denominator * factor;
  if (const auto exact = make_rate(rate.numerator, denominator)) {
    return *exact;
  }
  const double value = static_cast<double>(rate.numerator) / static_cast<double>(denominator);
  const auto millionths = static_cast<std::int64_t>(std::llround(value * kLargestTerm));
  return make_rate(std::max<std::int64_t>(1, millionths), kLargestTerm).value_or(FrameRate());
}

int frames_between(double before_s, double after_s, FrameRate rate) {
  const double steps = (after_s - before_s) * rate.per_second();
  return steps >= 1.5 && steps < 1e9 ? static_cast<int>(std::lround(steps)) - 1 : 0;
}

std::string to_string(FrameRate rate) {
  return rate.denominator == 1 ? fmt::format("{}", rate.numerator)
                               : fmt::format("{}/{}", rate.numerator, rate.denominator);
}

double FrameTimes::seconds(int frame) const {
  return static_cast<double>(times[static_cast<std::size_t>(frame)]) *
         static_cast<double>(unit_numerator) / static_cast<double>(unit_denominator);
}

FrameTimes FrameTimes::some(int first, int count, int step) const {
  assert(first >= 0 && count > 0 && first + (count - 1) * step < frame_count());
  FrameTimes chosen{{}, unit_numerator, unit_denominator, slowed_down(rate, step)};
  chosen.times.reserve(static_cast<std::size_t>(count) + 1);
  for (int i = 0; i <= count; ++i) {
    const int frame = std::min(first + i * step, frame_count());
    chosen.times.push_back(times[static_cast<std::size_t>(frame)]);
  }
  return chosen;
}

FrameTimes FrameTimes::of(const std::vector<int>& frames) const {
  FrameTimes chosen{{}, unit_numerator, unit_denominator, rate};
  for (const int frame : frames) {
    chosen.times.push_back(times[static_cast<std::size_t>(frame)]);
  }
  chosen.times.push_back(times[static_cast<std::size_t>(frames.back()) + 1]);
  return chosen;
}

bool are_uneven(const std::vector<std::int64_t>& times, double unit_seconds, FrameRate rate) {
  constexpr double kMaxFramesOff = 0.25;
  const double frames_per_unit = unit_seconds * rate.per_second();
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double frames = static_cast<double>(times[i] - times.front()) * frames_per_unit;
    if (std::abs(frames - static_cast<double>(i)) > kMaxFramesOff) {
      return true;
    }
  }
  return false;
}

}  // namespace vantage
