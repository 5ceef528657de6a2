// New views of given maps: any value may be in a map, none may leave the view's memory or time.
#include <array>
#include <cmath>
#include <variant>

#include "engine/execution.h"
#include "engine/synthesis/view_synthesizer.h"
#include "engine/view_geometry/new_view.h"
#include "tests/fuzz/target.h"

namespace vantage::fuzz {
namespace {

template <typename T>
Photograph photograph(Values& values, int width, int height, int channels) {
  Image<T> image(width, height, channels);
  for (int y = 0; y < height; ++y) {
    for (int i = 0; i < width * channels; ++i) {
      image.row(y)[i] = static_cast<T>(values.next<std::uint8_t>());
    }
  }
  return {std::move(image)};
}

/// Small disparities where a byte says so, else any float.
DisparityMap map(Values& values, int width, int height) {
  DisparityMap disparity(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto byte = values.next<std::uint8_t>();
      disparity.at(x, y) = byte == 255   ? values.next<float>()
                           : byte == 254 ? NAN
                           : byte == 253 ? INFINITY
                                         : static_cast<float>(byte) / 8 - 4;
    }
  }
  return disparity;
}

NewView new_view(Values& values, int width, int height) {
  NewView view =
      baseline_view(values.between(-32, 32) / 8.0, values.between(-8, 8) / 8.0, width, height);
  if (values.between(0, 1) == 1) {
    view.width_px = values.between(1, 40);
    view.height_px = values.between(1, 40);
    for (ViewWarp* const warp : {&view.from_left, &view.from_right}) {
      for (int k = 0; k < 9; ++k) {
        warp->homography(k / 3, k % 3) += values.between(-8, 8) / (k < 6 ? 8.0 : 64.0);
      }
      warp->parallax.z() = values.between(-8, 8) / 64.0;
    }
  }
  return view;
}

void synthesize(Bytes bytes) {
  static ExecutionOptions one_thread{.threads = 1};
  static Execution execution(one_thread);
  Values values(bytes);
  const int width = values.between(1, 24);
  const int height = values.between(1, 16);
  const int channels = std::array{1, 3, 4}[static_cast<std::size_t>(values.between(0, 2))];
  SynthesisOptions options;
  options.warp = static_cast<WarpColour>(values.between(0, 1));
  options.holes = static_cast<HoleFilling>(values.between(0, 5));
  options.match_intensities = values.between(0, 1) == 1;
  options.soft_edges = values.between(0, 1) == 1;
  const bool is_wide = values.between(0, 1) == 1;
  const NewView view = new_view(values, width, height);
  const DisparityMap left_map = map(values, width, height);
  const DisparityMap right_map = map(values, width, height);
  const auto image = [&] {
    return is_wide ? photograph<float>(values, width, height, channels)
                   : photograph<std::uint8_t>(values, width, height, channels);
  };
  const Photograph left = image();
  const Photograph right = image();
  SynthesizedView result;
  ViewSynthesizer(options, execution)
      .synthesize({left, right, left_map.view(), right_map.view()}, view, result);
  require(result.image.width() == view.width_px && result.image.height() == view.height_px,
          "a view of its size");
  require(result.hole_fraction >= 0 && result.hole_fraction <= 1, "a share of holes");
  if (const auto* const floats = std::get_if<Image<float>>(&result.image.pixels)) {
    for (int y = 0; y < floats->height(); ++y) {
      for (int i = 0; i < floats->width() * channels; ++i) {
        require(std::isfinite(floats->row(y)[i]), "a finite value");
      }
    }
  }
}

const Registration kView("view", synthesize, false);

}  // namespace
}  // namespace vantage::fuzz
