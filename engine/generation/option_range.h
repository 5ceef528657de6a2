#pragma once

namespace vantage {

/// Maximum side of a generated image.
inline constexpr int kMaxGeneratedSidePx = 16384;

/// Throws UsageError, naming `field`, when `value` is not in [low, high] or is NaN.
void require_between(const char* field, double value, double low, double high);

}  // namespace vantage
