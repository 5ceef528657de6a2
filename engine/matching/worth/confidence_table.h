// Made by perf/fit_confidence. See map_confidence.cc and perf/log/2026-11-27-confidence.md.
#pragma once

#include <array>

namespace vantage::confidence_table {

/// A place of a table, and its value there.
struct Entry {
  float at;
  float value;
};

/// Grey levels that are added to standard deviations in ratios.
inline constexpr float kNoise = 0.5F;
inline constexpr float kIntercept = 1.597F;
/// Weight of the mean score of the map.
inline constexpr float kOfMap = 0.434F;
inline constexpr float kUnmatched = 0.155F;
// clang-format off
inline constexpr std::array<Entry, 11> kResidual = {{{0, -1.762F}, {0.5F, -0.212F}, {1, -0.065F},
    {1.5F, -0.384F}, {2, -0.208F}, {3, -0.114F}, {4, 0.086F}, {6, -0.026F}, {9, 0.095F}, {14,
    0.214F}, {25, 0.761F}}};
inline constexpr std::array<Entry, 10> kTexture = {{{0, -0.763F}, {0.5F, -0.039F}, {1, -0.419F}, {2,
    0.105F}, {3, 0.204F}, {5, 0.083F}, {8, 0.160F}, {14, 0.296F}, {25, -0.094F}, {50, -0.709F}}};
inline constexpr std::array<Entry, 12> kRelativeResidual = {{{0, 0.191F}, {0.05F, 0.533F}, {0.1F,
    0.562F}, {0.15F, 0.351F}, {0.2F, 0.435F}, {0.3F, 0.348F}, {0.4F, 0.323F}, {0.55F, 0.171F},
    {0.7F, 0.240F}, {0.85F, 0.094F}, {1, -0.334F}, {1.2F, -0.556F}}};
inline constexpr std::array<Entry, 12> kSharpness = {{{0.5F, -0.255F}, {0.8F, -0.188F}, {1,
    -0.218F}, {1.2F, 0.049F}, {1.4F, 0.267F}, {1.7F, 0.525F}, {2, 0.632F}, {2.5F, 0.463F}, {3.5F,
    0.631F}, {5, 0.772F}, {8, 0.730F}, {15, 0.367F}}};
inline constexpr std::array<Entry, 6> kUnmatchedNear = {{{0, 0.282F}, {0.12F, -0.064F}, {0.28F,
    -0.200F}, {0.52F, -0.297F}, {0.76F, -0.450F}, {1, -0.522F}}};
inline constexpr std::array<Entry, 8> kUnmatchedFar = {{{0, 1.204F}, {0.04F, 0.594F}, {0.12F,
    0.080F}, {0.28F, -0.424F}, {0.44F, -0.762F}, {0.6F, -0.932F}, {0.8F, -1.379F}, {1, -2.220F}}};
inline constexpr std::array<Entry, 7> kAlike = {{{0.04F, -2.568F}, {0.2F, -2.056F}, {0.4F, -1.465F},
    {0.6F, -0.725F}, {0.8F, -0.428F}, {0.92F, -0.209F}, {1, 0.291F}}};
inline constexpr std::array<Entry, 6> kOutside = { {{-20, -0.070F}, {-6, 0.707F}, {0, 1.024F}, {2,
    1.582F}, {10, 1.656F}, {20, 0.826F}}};
/// From the sum of all to the probability.
inline constexpr std::array<Entry, 12> kLogistic = {{{-6, 0.043F}, {-4, 0.125F}, {-3, 0.125F}, {-2,
    0.184F}, {-1, 0.275F}, {0, 0.496F}, {1, 0.706F}, {2, 0.883F}, {3, 0.964F}, {4, 0.990F}, {5,
    0.990F}, {6, 0.990F}}};
// clang-format on

}  // namespace vantage::confidence_table
