// Kernels that refine finished maps.

#include <algorithm>
#include <limits>
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
  std::vector<float> own = map_row(1);
  std::vector<float> other = map_row(2);
  std::vector<float> snapped;
  AlignedValues<std::uint8_t> contradicted{kCount};
  AlignedValues<std::uint8_t> edges{kCount, 2, 1};

  static std::vector<float> map_row(unsigned seed) {
    std::mt19937 random(seed);
    return kernels::random_disparities(random, kWidth, 0, 40);
  }
  void cross_check() {
    kernels::cross_check_row(
        {.own_px = own.data(), .width = kWidth, .unmatched = contradicted.data()}, other.data());
  }
  void snap() {
    snapped = own;
    kernels::snap_discontinuities_row(edges.data(), 3, kWidth, snapped.data());
  }
};

/// A background and a foreground of different colours with an outline in the middle; runs of pixels
/// of both are filled.
struct FilledRows {
  static constexpr int kReach = kernels::kFilledMedianReachPx;
  static constexpr int kRows = 2 * kReach + 1;
  static constexpr int kMargin = kernels::kFilledMedianMarginPx;
  static constexpr int kPitch = kMargin + kWidth + kMargin;
  static constexpr int kFirstRun = 5;
  static constexpr int kEveryRun = 40;  // columns between the starts of runs
  /// Alternately a run that fills a vector partly and one of a few vectors.
  static constexpr int kRuns[] = {3, 19};

  std::vector<float> map_px =
      std::vector<float>(std::size_t{kPitch * kRows}, std::numeric_limits<float>::quiet_NaN());
  std::vector<std::uint8_t> pixels =
      std::vector<std::uint8_t>(std::size_t{kPitch * kRows * kernels::kFilledPixelBytes});
  AlignedValues<std::uint8_t> unmatched{kCount};
  std::vector<float> filled_px;

  FilledRows() {
    std::mt19937 random(3);
    for (int y = 0; y < kRows; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const bool is_front = x >= kWidth / 2;
        const int place = y * kPitch + kMargin + x;
        // Sub-pixel positions on slightly slanted surfaces.
        map_px[static_cast<std::size_t>(place)] = (is_front ? 30.0F : 8.0F) +
                                                  0.01F * static_cast<float>(x) +
                                                  static_cast<float>(random() % 64) / 256;
        for (int c = 0; c < 3; ++c) {
          pixels[static_cast<std::size_t>(place * kernels::kFilledPixelBytes + c)] =
              static_cast<std::uint8_t>((is_front ? 60 : 110) + random() % 40);
        }
      }
    }
    int run = 0;
    for (int x = kFirstRun; x < kWidth; x += kEveryRun) {
      std::fill_n(unmatched.data() + x, kRuns[run++ % 2], std::uint8_t{255});
    }
  }
  static int filled() {
    FilledRows rows;
    return static_cast<int>(
        std::count(rows.unmatched.data(), rows.unmatched.data() + kWidth, std::uint8_t{255}));
  }
  void take_medians() {
    constexpr int kFirst = kReach * kPitch + kMargin;
    const kernels::FilledRow row{
        .disparity_px = map_px.data() + kFirst,
        .disparity_pitch = kPitch,
        .pixels = pixels.data() + std::ptrdiff_t{kFirst * kernels::kFilledPixelBytes},
        .pixel_pitch = std::ptrdiff_t{kPitch * kernels::kFilledPixelBytes},
        .unmatched = unmatched.data(),
        .width = kWidth};
    filled_px.assign(row.disparity_px, row.disparity_px + kWidth);
    kernels::take_filled_medians_row(row, filled_px.data());
  }
};

KernelBenchmark plain(KernelBenchmark kernel) {
  kernel.has_vectors = false;
  return kernel;
}

}  // namespace

KernelBenchmarks refinement_kernels() {
  const int filled = FilledRows::filled();
  return {
      on_own_data<Rows>("cross_check_row", "pixel", kWidth, {0, 9},
                        [](Rows& d) { d.cross_check(); }),
      plain(on_own_data<Rows>("snap_discontinuities_row", "pixel", kWidth, {},
                              [](Rows& d) { d.snap(); })),
      on_own_data<FilledRows>("take_filled_medians_row, of filled pixels", "pixel", filled, {},
                              [](FilledRows& d) { d.take_medians(); }),
  };
}

}  // namespace vantage::perf
