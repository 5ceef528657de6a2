#include "kernels/colour_fetch/colour_fetch.h"

#include "kernels/forward_warp/forward_warp.h"
#include "tests/kernels/plain_taps.h"
#include "tests/kernels/synthesis_rows.h"
#include "tests/keys_kernel.h"

namespace vantage::kernels::colour_fetch_test {

using test::keys;

std::vector<float> random_values(std::mt19937& random, int count) {
  std::vector<float> values(count);
  for (float& value : values) {
    value = static_cast<float>(random() % 256);
  }
  return values;
}

struct Scanline {
  std::vector<float> disparity_px;
  RowWithMargins source_disparity;
  std::vector<float> values;  ///< [x · channels + c]
  PlanesWithMargins pixels;
  std::vector<float> warped_disparity_px;
  std::vector<float> source_column;

  Scanline(const std::vector<float>& disparities, const std::vector<float>& colours, int channels,
           double s)
      : disparity_px(disparities),
        source_disparity(disparities, kUnknownDisparity),
        values(colours),
        pixels(values.data(), static_cast<int>(disparities.size()), channels),
        warped_disparity_px(disparities.size()),
        source_column(disparities.size()) {
    forward_warp_row({disparity_px.data(), static_cast<int>(disparity_px.size()), s, 1.0F},
                     warped_disparity_px.data(), source_column.data());
  }

  [[nodiscard]] BicubicFetchRow bicubic(int channels, double s, float limit) const {
    return {.pixels = pixels.row(),
            .stride = pixels.stride(),
            .source_disparity_px = source_disparity.row(),
            .warped_disparity_px = warped_disparity_px.data(),
            .width = static_cast<int>(disparity_px.size()),
            .channels = channels,
            .camera_offset = s,
            .gradient_limit_px = limit,
            .largest_value = 255};
  }
};

/// The contract in double.
double plain_colour(const BicubicFetchRow& row, int n, int c) {
  const float d = row.warped_disparity_px[n];
  if (std::isnan(d)) {
    return 0;
  }
  const double column = std::clamp(n + row.camera_offset * d, -1.0, row.width - 0.5);
  const int first = static_cast<int>(std::floor(column)) - 1;
  const auto fraction = static_cast<float>(column - std::floor(column));
  bool on_surface[4];
  for (int k = 0; k < 4; ++k) {
    const int x = first + k;
    on_surface[k] = x >= 0 && x < row.width &&
                    std::abs(row.source_disparity_px[x] - d) <= row.gradient_limit_px;
  }
  const PlainTaps taps = plain_taps(on_surface, first, row.width, fraction);
  double sum = 0;
  double min = 0;
  double max = row.largest_value;
  for (int k = 0; k < 4; ++k) {
    const double value = row.pixels[c * row.stride + first + taps.from[k]];
    sum += keys(1.0 - k + fraction) * value;
    min = std::min(min, value);
    max = std::max(max, value);
  }
  return std::clamp(sum, min, max);
}

/// What a row comes out as, on every instruction set.
std::vector<float> expect_plain_colours(const BicubicFetchRow& row) {
  const int lanes = pixel_lanes(row.channels);
  const auto colours = row_on_every_target<float>(row.width * lanes, fetch_bicubic_row, row);
  for (int n = 0; n < row.width; ++n) {
    for (int c = 0; c < lanes; ++c) {
      const double expected = c < row.channels ? plain_colour(row, n, c) : 0;
      EXPECT_NEAR(colours[n * lanes + c], expected, 1e-3)
          << row.width << " wide, " << row.channels << " channels, s " << row.camera_offset;
    }
  }
  return colours;
}

TEST(FetchBicubic, IsTheDefinition) {
  std::mt19937 random(4);
  for (const int width : kAwkwardWidths) {
    for (const int channels : {1, 3, 4}) {
      for (const double s : {-0.7, 0.0, 0.3, 1.0, 2.2}) {
        const Scanline line(random_disparities(random, width, -5, 20),
                            random_values(random, width * channels), channels, s);
        for (const float limit : {0.0F, 1.0F}) {
          BicubicFetchRow row = line.bicubic(channels, s, limit);
          const std::vector<float> colours = expect_plain_colours(row);
          row.is_in_range = true;
          ASSERT_EQ(expect_plain_colours(row), colours);
        }
      }
    }
  }
}

TEST(FetchBicubic, IsTheDefinitionForAnyDisparitiesAndValues) {
  std::mt19937 random(7);
  for (const int width : kAwkwardWidths) {
    for (const int channels : {1, 3, 4}) {
      for (const double s : {-1.3, 0.4}) {
        // Disparities that no warp gave: columns off the surface and beyond the image's borders.
        Scanline line(random_disparities(random, width, -5, 20),
                      random_values(random, width * channels), channels, s);
        for (float& d : line.warped_disparity_px) {
          d = random() % 8 == 0 ? kUnknownDisparity : static_cast<float>(random() % 160) / 8 - 5;
        }
        BicubicFetchRow row = line.bicubic(channels, s, 1.0F);
        // Many pixels are outside the range of their type, as floats may be.
        row.largest_value = 100;
        expect_plain_colours(row);
      }
    }
  }
}

TEST(FetchBicubic, IsKeysConvolutionWithReplicatedBorder) {
  std::mt19937 random(5);
  for (const int width : {1, 2, 3, 17, 80}) {
    for (const double s : {-0.5, 0.25, 1.0}) {
      // One surface whose disparity has a fraction.
      const std::vector<float> disparities(width, 1.3F);
      const std::vector<float> values = random_values(random, width);
      const Scanline line(disparities, values, 1, s);
      std::vector<float> colours(width);
      fetch_bicubic_row(line.bicubic(1, s, 1.0F), colours.data());
      for (int n = 0; n < width; ++n) {
        if (std::isnan(line.warped_disparity_px[n])) {
          EXPECT_EQ(colours[n], 0);
          continue;
        }
        const double column = n + s * 1.3F;
        double expected = 0;
        for (int x = -4; x < width + 4; ++x) {
          const int inside = std::clamp(x, 0, width - 1);
          expected += keys(column - x) * values[inside];
        }
        EXPECT_NEAR(colours[n], std::clamp(expected, 0.0, 255.0), 1e-3);
      }
    }
  }
}

TEST(FetchBicubic, DoesNotMixSurfaces) {
  // Foreground of 200 at d = 8.4, background of 50 at d = 0.4: only these two colours may appear.
  std::vector<float> disparities(60, 0.4F);
  std::vector<float> values(60, 50.0F);
  for (std::size_t x = 25; x < 40; ++x) {
    disparities[x] = 8.4F;
    values[x] = 200;
  }
  for (const double s : {-0.5, 0.3, 0.5}) {
    const Scanline line(disparities, values, 1, s);
    std::vector<float> colours(60);
    fetch_bicubic_row(line.bicubic(1, s, 1.0F), colours.data());
    for (std::size_t n = 0; n < 60; ++n) {
      const float d = line.warped_disparity_px[n];
      EXPECT_NEAR(colours[n], std::isnan(d) ? 0.0F : d > 4 ? 200.0F : 50.0F, 1e-3F) << n;
    }
  }
}

TEST(FetchForward, SourcePixelsAndLinearGaps) {
  std::mt19937 random(6);
  for (const int width : kAwkwardWidths) {
    for (const int channels : {1, 3, 4}) {
      const std::vector<float> values = random_values(random, width * channels);
      const Scanline line(random_disparities(random, width, -5, 20), values, channels, -0.6);
      const int lanes = pixel_lanes(channels);
      std::vector<float> colours(width * lanes, -1.0F);
      fetch_forward_row(
          {line.pixels.row(), line.pixels.stride(), line.source_column.data(), width, channels},
          colours.data());
      for (int n = 0; n < width; ++n) {
        const float column = line.source_column[n];
        for (int c = 0; c < lanes; ++c) {
          double expected = 0;
          if (!std::isnan(column) && c < channels) {
            const int x = static_cast<int>(std::floor(column));
            const int next = std::min(x + 1, width - 1);
            const double f = static_cast<double>(column) - x;
            expected = (1 - f) * values[x * channels + c] + f * values[next * channels + c];
          }
          ASSERT_NEAR(colours[n * lanes + c], expected, 1e-4);
        }
      }
    }
  }
}

}  // namespace vantage::kernels::colour_fetch_test
