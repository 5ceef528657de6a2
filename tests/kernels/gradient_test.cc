#include "kernels/gradient/gradient.h"

#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::gradient_test {

constexpr FilterTaps kFilters[] = {{0, 0, 1, 0, 0},
                                   {0, -1, 0, 1, 0},
                                   {-.1077F, -.2827F, 0, .2827F, .1077F},
                                   {.1F, .2F, .3F, -.4F, .5F}};

TEST(Gradient, SeparableFilter) {
  std::mt19937 random(1);
  for (const int width : {1, 2, 12, 13, 16, 17, 50}) {
    for (const FilterTaps& down : kFilters) {
      for (const FilterTaps& along : kFilters) {
        // Two columns before the image, and whole vectors from there on.
        const auto size = static_cast<std::size_t>((width + 4 + 15) / 16 * 16);
        std::vector<UnalignedRow<float>> rows;
        SeparableFilter filter;
        for (std::size_t v = 0; v < 5; ++v) {
          rows.emplace_back(size, random() % 5);
          for (std::size_t k = 0; k < size; ++k) {
            rows.back()[k] = static_cast<float>(random() % 25501U) / 100;
          }
          filter.rows[v] = rows.back().data() + kFilterRadius;
        }
        filter.down = down;
        filter.along = along;
        filter.width = width;
        std::vector<float> work(static_cast<std::size_t>(width) + 48);
        const auto padded = static_cast<std::size_t>((width + 15) / 16 * 16);
        const auto filtered = row_on_every_target<float>(padded, [&](float* out) {
          separable_filter_row(filter, work.data(), out);
          std::fill(out + width, out + padded, 0.0F);  // anything
        });
        for (int x = 0; x < width; ++x) {
          double sum = 0;
          for (int v = -2; v <= 2; ++v) {
            for (int u = -2; u <= 2; ++u) {
              const auto row = static_cast<std::size_t>(v + 2);
              const auto column = static_cast<std::size_t>(u + 2);
              sum += double{down[row]} * along[column] * filter.rows[row][x + u];
            }
          }
          ASSERT_NEAR(filtered[x], sum, 3e-4);
        }
      }
    }
  }
}

}  // namespace vantage::kernels::gradient_test
