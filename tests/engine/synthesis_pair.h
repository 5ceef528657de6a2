#pragma once

#include "engine/synthesis/view_synthesizer.h"
#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {

/// What views are made from.
struct SynthesisPair {
  Photograph left;
  Photograph right;
  DisparityMap left_disparity;
  DisparityMap right_disparity;

  /// `position`: baselines from the left camera, or a NewView.
  template <typename Position>
  void synthesize(const SynthesisOptions& options, const Position& position, Execution& execution,
                  SynthesizedView& view,
                  const std::array<IntensityFit, 4>* given_fit = nullptr) const {
    ViewSynthesizer(options, execution)
        .synthesize({left, right, left_disparity.view(), right_disparity.view()}, position, view,
                    given_fit);
  }
};

/// Stripes with noise, so that regression has something to find; grey levels of the right image are
/// `gain` times those of the left. make_map(): a disparity map.
template <typename T, typename MakeMap>
SynthesisPair random_synthesis_pair(std::mt19937& random, int width, int height, int channels,
                                    double gain, const MakeMap& make_map) {
  const auto picture = [&](double factor) {
    Image<T> image(width, height, channels);
    for (const auto [k, y] : positions_of(width * channels, height)) {
      const double grey = factor * (30.0 + 12 * (y % 16)) + static_cast<double>(random() % 20);
      image.row(y)[k] = static_cast<T>(grey / static_cast<double>(kGreyLevelsPerUnit<T>));
    }
    return Photograph{std::move(image)};
  };
  return {picture(1), picture(gain), make_map(), make_map()};
}

/// All that a view holds.
inline std::vector<std::uint8_t> bytes_of(const SynthesizedView& view) {
  std::vector<std::uint8_t> bytes;
  const auto append = [&]<typename T>(const Image<T>& image) {
    for (int y = 0; y < image.height(); ++y) {
      const auto* row = reinterpret_cast<const std::uint8_t*>(image.row(y));
      bytes.insert(bytes.end(), row,
                   row + sizeof(T) * static_cast<std::size_t>(image.width() * image.channels()));
    }
  };
  std::visit(append, view.image.pixels);
  append(view.holes);
  append(view.sources);
  const auto* fit = reinterpret_cast<const std::uint8_t*>(view.intensity.data());
  bytes.insert(bytes.end(), fit, fit + sizeof(view.intensity));
  return bytes;
}

}  // namespace test
}  // namespace vantage
