#include "engine/tuning/candidate_ladder.h"

#include <algorithm>

namespace vantage {
namespace {

constexpr double kCoarseStep = 1.5;

}  // namespace

std::vector<int> coarse_ladder(int max) {
  std::vector<int> values;
  for (int value = 1; value < max;
       value = std::max(value + 1, static_cast<int>(value * kCoarseStep))) {
    values.push_back(value);
  }
  values.push_back(std::max(1, max));
  return values;
}

std::vector<int> fine_ladder(int value, int max) {
  std::vector<int> values;
  for (const int distance : {1, value / 6, value / 3}) {
    for (const int near : {value - distance, value + distance}) {
      if (distance > 0 && near >= 1 && near <= max) {
        values.push_back(near);
      }
    }
  }
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

}  // namespace vantage
