#include "engine/profiling/quantity_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vantage {
namespace {

constexpr std::string_view kNothing = "–";
constexpr std::string_view kNoBreak = "\u00A0";

struct Prefix {
  std::string_view text;
  double factor = 1;
};

Prefix prefix_for(double value) {
  constexpr Prefix kPrefixes[] = {{"T", 1e12}, {"G", 1e9},  {"M", 1e6},  {"k", 1e3},
                                  {"", 1},     {"m", 1e-3}, {"µ", 1e-6}, {"n", 1e-9}};
  const double size = std::abs(value);
  if (size == 0) {
    return {"", 1};
  }
  for (const Prefix& prefix : kPrefixes) {
    if (size >= 0.9995 * prefix.factor) {  // values that round to it
      return prefix;
    }
  }
  return {"n", 1e-9};
}

}  // namespace

std::string number_text(double value) {
  if (!std::isfinite(value)) {
    return std::string(kNothing);
  }
  const double size = std::abs(value);
  if (size == 0) {
    return "0";
  }
  if (size >= 1e6 || size < 1e-4) {
    return fmt::format("{:.2e}", value);
  }
  const int digits = std::clamp(2 - static_cast<int>(std::floor(std::log10(size * 1.0005))), 0, 6);
  return fmt::format("{:.{}f}", value, digits);
}

std::string quantity_text(double value, std::string_view unit) {
  if (!std::isfinite(value)) {
    return std::string(kNothing);
  }
  const Prefix prefix = prefix_for(value);
  return fmt::format("{}{}{}{}", number_text(value / prefix.factor), kNoBreak, prefix.text, unit);
}

std::string sample_text(const ProfileSample& sample, std::string_view unit) {
  if (!std::isfinite(sample.median)) {
    return std::string(kNothing);
  }
  const Prefix prefix = prefix_for(sample.median);
  const std::string median = number_text(sample.median / prefix.factor);
  const std::string min = number_text(sample.min / prefix.factor);
  const std::string max = number_text(sample.max / prefix.factor);
  const bool has_range = min != median || max != median;
  return median + (has_range ? fmt::format("{}({}–{})", kNoBreak, min, max) : "") +
         fmt::format("{}{}{}", kNoBreak, prefix.text, unit);
}

std::string percent_text(double share) {
  if (!std::isfinite(share)) {
    return std::string(kNothing);
  }
  const double percent = 100 * share;
  const double size = std::abs(percent);
  const int digits = size >= 9.95 || size == 0 ? 0 : size >= 0.995 ? 1 : 2;
  return fmt::format("{:.{}f}{}%", percent, digits, kNoBreak);
}

}  // namespace vantage
