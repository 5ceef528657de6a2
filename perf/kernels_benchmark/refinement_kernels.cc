// What makes maps better once they are there.

#include <random>
#include <utility>
#include <vector>

#include "kernels/cross_check/cross_check.h"
#include "kernels/edge_snapping/edge_snapping.h"
#include "kernels/filled_median/filled_median.h"
#include "perf/kernels_benchmark/kernel_benchmark.h"
#include "tests/kernels/synthesis_rows.h"

namespace vantage::perf {
namespace {

constexpr int kWidth = 256;
constexpr std::size_t kCount = kWidth;

struct Rows {
  // As far as the median looks in both directions.
  static constexpr int kReach = kernels::kFilledMedianSamples / 2 * kernels::kFilledMedianStepPx;
  static constexpr int kRows = 2 * kReach + 1;
  static constexpr int kEveryFilled = 10;  // pixel of a row was not matched

  std::vector<float> own = map_row(1);
  std::vector<float> other = map_row(2);
  std::vector<float> map;
  std::vector<float> snapped;
  AlignedValues<std::uint8_t> pixels{kCount * kRows, 256, 1};
  AlignedValues<std::uint8_t> unmatched{kCount};
  AlignedValues<std::uint8_t> contradicted{kCount};
  AlignedValues<std::uint8_t> edges{kCount, 2, 1};

  Rows() {
    for (int y = 0; y < kRows; ++y) {
      const std::vector<float> row = map_row(static_cast<unsigned>(y));
      map.insert(map.end(), row.begin(), row.end());
    }
    for (int x = 0; x < kWidth; x += kEveryFilled) {
      unmatched.data()[x] = 255;
    }
  }
  static std::vector<float> map_row(unsigned seed) {
    std::mt19937 random(seed);
    return kernels::random_disparities(random, kWidth, 0, 40);
  }
  void cross_check() {
    kernels::cross_check_row(own.data(), other.data(), -1, 1.0, kWidth, contradicted.data());
  }
  void snap() {
    snapped = own;
    kernels::snap_discontinuities_row(edges.data(), 3, kWidth, snapped.data());
  }
  void take_medians() {
    kernels::FilledRow row;
    row.disparity_px = map.data() + kReach * kWidth;
    row.disparity_pitch = kWidth;
    row.pixels = pixels.data() + kReach * kWidth;
    row.pixel_pitch = kWidth;
    row.unmatched = unmatched.data();
    row.width = kWidth;
    row.rows_above = row.rows_below = kReach;
    snapped.assign(row.disparity_px, row.disparity_px + kWidth);
    kernels::take_filled_medians_row(row, snapped.data());
  }
};

KernelBenchmark plain(std::string name, double pixels, void (*call)(Rows&)) {
  KernelBenchmark kernel = on_own_data<Rows>(std::move(name), "pixel", pixels, {}, call);
  kernel.has_vectors = false;
  return kernel;
}

}  // namespace

KernelBenchmarks refinement_kernels() {
  constexpr int kFilled = (kWidth + Rows::kEveryFilled - 1) / Rows::kEveryFilled;
  return {
      on_own_data<Rows>("cross_check_row", "pixel", kWidth, {0, 9},
                        [](Rows& d) { d.cross_check(); }),
      plain("snap_discontinuities_row", kWidth, [](Rows& d) { d.snap(); }),
      plain("take_filled_medians_row, of filled pixels", kFilled,
            [](Rows& d) { d.take_medians(); }),
  };
}

}  // namespace vantage::perf
