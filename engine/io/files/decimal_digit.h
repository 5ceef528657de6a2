#pragma once

namespace vantage {

/// Whether `letter` is 0 to 9, in any locale.
constexpr bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }

}  // namespace vantage
