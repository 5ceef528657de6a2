// New views: forward mapping, positions, colours, blending. Kernels that branch or gather have no
// counted operations; their bytes are those of their rows and taps.

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "kernels/bicubic_remap/bicubic_remap.h"
#include "kernels/colour_fetch/colour_fetch.h"
#include "kernels/forward_warp/forward_warp.h"
#include "kernels/intensity_sums/intensity_sums.h"
#include "kernels/pixel_row/pixel_row.h"
#include "kernels/source_position/source_position.h"
#include "kernels/surface_fetch/surface_fetch.h"
#include "kernels/surface_splat/surface_splat.h"
#include "kernels/view_blend/view_blend.h"
#include "kernels/view_projection/view_projection.h"
#include "perf/kernels_benchmark/kernel_benchmark.h"
#include "tests/kernels/projection_cases.h"

namespace vantage::perf {
namespace {

constexpr int kWidth = 256;
constexpr std::size_t kCount = kWidth;

/// Weights of the four taps of a bicubic interpolation.
constexpr double kKeysWeights = 16;

std::vector<float> disparities(unsigned seed) {
  std::mt19937 random(seed);
  return kernels::random_disparities(random, kWidth, 0, 40);
}

/// Forward warp along a row, and fetching back.
template <int kChannels>
struct AlongRow {
  static constexpr int kPixelLanes = kernels::pixel_lanes(kChannels);
  std::vector<float> map = disparities(1);
  kernels::RowWithMargins map_row{map, kernels::kUnknownDisparity};
  AlignedValues<std::uint8_t> pixels{kCount * kChannels, 256, 1};
  static constexpr std::size_t kStride = kCount + 2 * kernels::kRowMarginPx;
  AlignedValues<float> planes{kStride * kChannels};
  AlignedValues<float> warped_px{kCount};
  AlignedValues<float> source_column{kCount};
  AlignedValues<float> colours{kCount * kPixelLanes};

  AlongRow() {
    load();
    warp();
  }
  float* first_pixel() { return planes.data() + kernels::kRowMarginPx; }
  void load() {
    kernels::load_pixel_planes(pixels.data(), kWidth, kChannels, kStride, first_pixel());
  }
  void warp() {
    kernels::forward_warp_row({map.data(), kWidth, 0.5, 1}, warped_px.data(), source_column.data());
  }
  [[nodiscard]] kernels::BicubicFetchRow row() {
    return {.pixels = first_pixel(),
            .stride = kStride,
            .source_disparity_px = map_row.row(),
            .warped_disparity_px = warped_px.data(),
            .width = kWidth,
            .channels = kChannels,
            .camera_offset = 0.5,
            .is_in_range = true};
  }
  void fetch() { kernels::fetch_bicubic_row(row(), colours.data()); }
};

/// An image and positions in it, all on one surface.
template <int kChannels>
struct Places {
  static constexpr int kImageWidth = 300;
  static constexpr int kImageHeight = 24;
  static constexpr std::size_t kImagePixels = kImageWidth * kImageHeight;
  AlignedValues<std::uint8_t> pixels{kImagePixels * kChannels, 256, 1};
  AlignedValues<float> map_px{kImagePixels};
  AlignedValues<std::int32_t> column{kCount};
  AlignedValues<std::int32_t> line{kCount};
  AlignedValues<float> fraction_x{kCount};
  AlignedValues<float> fraction_y{kCount};
  AlignedValues<float> x_px{kCount};
  AlignedValues<float> y_px{kCount};
  AlignedValues<float> disparity_px{kCount};
  AlignedValues<float> colours{kCount * kernels::pixel_lanes(kChannels)};
  AlignedValues<std::uint8_t> result{kCount * kChannels};

  Places() {
    for (int i = 0; i < kWidth; ++i) {
      const float x = 4.3F + 1.05F * static_cast<float>(i);
      const float y = 4.7F + 0.05F * static_cast<float>(i);
      x_px.data()[i] = x;
      y_px.data()[i] = y;
      column.data()[i] = static_cast<std::int32_t>(x);
      line.data()[i] = static_cast<std::int32_t>(y);
      fraction_x.data()[i] = x - std::floor(x);
      fraction_y.data()[i] = y - std::floor(y);
    }
  }
  void remap() {
    kernels::remap_bicubic_row(
        kernels::RemapRow<std::uint8_t>{pixels.data(), kImageWidth * kChannels, kImageWidth,
                                        kImageHeight, kChannels, x_px.data(), y_px.data(), kWidth},
        result.data());
  }
  void fetch() {
    kernels::SurfaceFetchRow<std::uint8_t> row;
    row.pixels = pixels.data();
    row.stride = kImageWidth * kChannels;
    row.map_px = map_px.data();
    row.map_stride = kImageWidth;
    row.width = kImageWidth;
    row.height = kImageHeight;
    row.channels = kChannels;
    row.column = column.data();
    row.line = line.data();
    row.fraction_x = fraction_x.data();
    row.fraction_y = fraction_y.data();
    row.disparity_px = disparity_px.data();
    row.count = kWidth;
    kernels::fetch_surface_row(row, colours.data());
  }
};

/// Forward mapping into a slightly rolled view, and the inverse mapping.
struct Rolled {
  static constexpr int kLine = 100;
  static constexpr int kLines = 64;
  std::vector<float> upper = disparities(1);
  std::vector<float> lower = disparities(2);
  kernels::ViewProjection view =
      kernels::camera(500, 1, 0.05, 0.01, 0, {0.5, 0.3, 0}, kWidth / 2.0, kLine, 0);
  kernels::ProjectedValues upper_row{kWidth};
  kernels::ProjectedValues lower_row{kWidth};
  AlignedValues<float> nearness{kCount * kLines};
  AlignedValues<std::int32_t> column{kCount};
  AlignedValues<std::int32_t> line{kCount};
  AlignedValues<float> fraction_x{kCount};
  AlignedValues<float> fraction_y{kCount};
  AlignedValues<float> disparity_px{kCount};
  AlignedValues<float> found_nearness{kCount};

  Rolled() {
    project(upper, kLine, upper_row);
    project(lower, kLine + 1, lower_row);
    std::fill_n(nearness.data(), kCount * kLines, -INFINITY);
  }
  void project(const std::vector<float>& map, int y, kernels::ProjectedValues& row) {
    kernels::project_row(view, {map.data(), kWidth, 0, y}, row.row());
  }
  void splat() {
    kernels::SplatRows rows;
    rows.view = view;
    rows.upper = upper_row.row();
    rows.lower = lower_row.row();
    rows.count = kWidth - 1;
    rows.line = kLine;
    rows.right_edge = kernels::right_edge_direction(view, kWidth / 2.0, kLine);
    rows.lower_edge = kernels::lower_edge_direction(view, kWidth / 2.0, kLine);
    kernels::splat_rows(rows, {nearness.data(), kWidth, kWidth, kLine - kLines / 2, kLines});
  }
  void find_sources() {
    kernels::SourceProjection back;
    const double homography[9] = {1, 0.05, -4, -0.05, 1, 5, 1e-5, -1e-5, 1};
    std::copy_n(homography, 9, back.homography);
    back.parallax[0] = -0.5;
    back.parallax[1] = -0.3;
    back.is_translation = false;
    kernels::source_positions_row(back, {upper_row.row().nearness, kWidth, kLine, kWidth, 240},
                                  {column.data(), line.data(), fraction_x.data(), fraction_y.data(),
                                   disparity_px.data(), found_nearness.data()});
  }
};

/// Fetches and blends two rows of colours.
struct FetchedBlend {
  AlongRow<3> image;
  AlignedValues<std::uint8_t> pixels{kCount * 3};
  AlignedValues<float> disparity_px{kCount};
  AlignedValues<std::uint8_t> holes{kCount};
  AlignedValues<std::uint8_t> sources{kCount};

  void blend() {
    kernels::blend_fetched_row({image.row(), image.row(), {}}, {},
                               kernels::BlendedRow<std::uint8_t>{pixels.data(), disparity_px.data(),
                                                                 holes.data(), sources.data()});
  }
};

/// Blends two warped rows of colours.
struct Blend {
  std::mt19937 random{1};
  kernels::RandomPair pair{random, kWidth, 3, 255};
  AlignedValues<std::uint8_t> pixels{kCount * 3};
  AlignedValues<float> disparity_px{kCount};
  AlignedValues<std::uint8_t> holes{kCount};
  AlignedValues<std::uint8_t> sources{kCount};
  kernels::IntensitySums sums;

  void blend() {
    kernels::blend_row(pair.row, {}, 3,
                       kernels::BlendedRow<std::uint8_t>{pixels.data(), disparity_px.data(),
                                                         holes.data(), sources.data()});
  }
  void sum() { sums = kernels::intensity_sums_row(pair.row); }
};

template <class Data>
KernelBenchmark of_pixels(std::string name, UnitWork work, void (*call)(Data&)) {
  return on_own_data<Data>(std::move(name), "pixel", kWidth, work, call);
}

}  // namespace

KernelBenchmarks view_kernels() {
  using Grey = AlongRow<1>;
  using Colour = AlongRow<3>;
  KernelBenchmark sums =
      of_pixels<Blend>("intensity_sums_row/RGB", {0, 40}, [](Blend& d) { d.sum(); });
  sums.has_vectors = false;
  return {
      of_pixels<Grey>("load_pixel_planes/grey", {0, 5}, [](Grey& d) { d.load(); }),
      of_pixels<Colour>("load_pixel_planes/RGB", {0, 19}, [](Colour& d) { d.load(); }),
      of_pixels<Grey>("forward_warp_row", {0, 12}, [](Grey& d) { d.warp(); }),
      // Position 5, weights, surfaces of the taps 8; then 7 and two limits per channel.
      of_pixels<Grey>("fetch_bicubic_row/grey", {5 + kKeysWeights + 8 + 9, 40},
                      [](Grey& d) { d.fetch(); }),
      of_pixels<Colour>("fetch_bicubic_row/RGB", {5 + kKeysWeights + 8 + 27, 100},
                        [](Colour& d) { d.fetch(); }),
      // Weights in both directions; 7 per tap over the rows, 7 along the row, rounding, two limits.
      of_pixels<Places<1>>("remap_bicubic_row/grey", {2 + 2 * kKeysWeights + 38, 8 + 16 + 1},
                           [](Places<1>& d) { d.remap(); }),
      of_pixels<Places<3>>("remap_bicubic_row/RGB", {2 + 2 * kKeysWeights + 3 * 38, 8 + 48 + 3},
                           [](Places<3>& d) { d.remap(); }),
      of_pixels<Places<1>>("fetch_surface_row/grey", {0, 20 + 64 + 16 + 4},
                           [](Places<1>& d) { d.fetch(); }),
      of_pixels<Places<3>>("fetch_surface_row/RGB", {0, 20 + 64 + 48 + 16},
                           [](Places<3>& d) { d.fetch(); }),
      of_pixels<Rolled>("project_row", {0, 20},
                        [](Rolled& d) { d.project(d.upper, Rolled::kLine, d.upper_row); }),
      of_pixels<Rolled>("splat_rows", {0, 32}, [](Rolled& d) { d.splat(); }),
      of_pixels<Rolled>("source_positions_row", {0, 28}, [](Rolled& d) { d.find_sources(); }),
      of_pixels<Blend>("blend_row/RGB", {0, 49}, [](Blend& d) { d.blend(); }),
      // Both fetches and the blending, without the colours in between.
      of_pixels<FetchedBlend>("blend_fetched_row/RGB",
                              {2 * (5 + kKeysWeights + 8 + 27) + 40, 2 * 84 + 9},
                              [](FetchedBlend& d) { d.blend(); }),
      sums,
  };
}

}  // namespace vantage::perf
