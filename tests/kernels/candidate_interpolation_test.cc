#include "kernels/candidate_interpolation/candidate_interpolation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vantage::kernels {
namespace candidate_interpolation_test {

std::vector<CandidateShift> shifts_of(double min, double step, int lanes) {
  std::vector<CandidateShift> shifts;
  for (int i = 0; i < lanes; ++i) {
    const double shift = min + i * step;
    shifts.push_back(
        {static_cast<int>(std::floor(shift)), static_cast<float>(shift - std::floor(shift))});
  }
  return shifts;
}

TEST(CandidateInterpolation, EqualsLinearInterpolation) {
  for (const int width : {1, 2, 9, 40}) {
    std::vector<float> row;
    for (int x = 0; x < width; ++x) {
      row.push_back(static_cast<float>(x * x % 23));
    }
    for (const double step : {.25, .5, 1.375, 2.}) {
      const double min = -4.25;
      const auto shifts = shifts_of(min, step, 16);
      for (const int position_step : {-1, 1}) {
        const int first = position_step < 0 ? width - 1 : 0;
        std::vector<float> values(static_cast<std::size_t>(width) * 16);
        interpolate_candidates({width, first, position_step, width, 16}, shifts.data(), row.data(),
                               values.data());
        for (int j = 0; j < width; ++j) {
          const int position = first + j * position_step;
          const CandidateRange inside = candidates_inside(shifts.data(), 13, width, position);
          for (int i = 0; i < 16; ++i) {
            const double exact = position + min + i * step;
            const double at = std::clamp<double>(exact, 0, width - 1);
            const int below = static_cast<int>(at);
            const int above = std::min(below + 1, width - 1);
            const double fraction = at - below;
            EXPECT_NEAR(values[static_cast<std::size_t>(j * 16 + i)],
                        (1 - fraction) * row[static_cast<std::size_t>(below)] +
                            fraction * row[static_cast<std::size_t>(above)],
                        1e-5);
            if (i < 13) {
              EXPECT_EQ(i >= inside.begin && i < inside.end, exact >= 0 && exact <= width - 1)
                  << "width " << width << ", position " << exact;
            }
          }
        }
      }
    }
  }
}

}  // namespace candidate_interpolation_test
}  // namespace vantage::kernels
