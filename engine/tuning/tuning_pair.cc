#include "engine/tuning/tuning_pair.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "engine/generation/layered_scene.h"
#include "engine/image/intensity_rows.h"

namespace vantage {
namespace {

// Rendering takes longer than fast methods take to match, so only this many rows are rendered.
constexpr int kRenderedRows = 192;

/// Row y of an image of `rows` rows that is extended by reflection.
int mirrored_row(int y, int rows) {
  const int place = y % (2 * rows);
  return place < rows ? place : 2 * rows - 1 - place;
}

Photograph to_grey(const Photograph& colour) {
  Image<std::uint8_t> grey(colour.width(), colour.height());
  std::vector<float> levels(static_cast<std::size_t>(colour.width()));
  for (int y = 0; y < grey.height(); ++y) {
    intensity_row(colour, y, levels.data());
    std::ranges::transform(levels, grey.row(y), [](float level) {
      return static_cast<std::uint8_t>(std::lround(level));
    });
  }
  return {std::move(grey)};
}

Photograph with_rows(const Photograph& photograph, int rows) {
  return std::visit(
      [rows](const auto& source) -> Photograph {
        auto image = std::remove_cvref_t<decltype(source)>(source.width(), rows, source.channels());
        for (int y = 0; y < rows; ++y) {
          std::copy_n(source.row(mirrored_row(y, source.height())),
                      static_cast<std::size_t>(source.width()) *
                          static_cast<std::size_t>(source.channels()),
                      image.row(y));
        }
        return {std::move(image)};
      },
      photograph.pixels);
}

}  // namespace

TuningPair make_tuning_pair(int width_px, int height_px, DisparityRange disparities, bool grey,
                            Execution& execution) {
  LayeredSceneOptions options;
  options.width_px = width_px;
  options.height_px = std::min(height_px, kRenderedRows);
  options.samples_per_side = 1;
  const int reach = std::max(std::abs(disparities.min), std::abs(disparities.max));
  options.near_disparity_px = std::max(1.0, 0.9 * std::min(reach, width_px));
  options.far_disparity_px = *options.near_disparity_px / 9;
  const LayeredScene scene(options, execution);
  const bool is_mirrored = std::abs(disparities.min) > std::abs(disparities.max);
  const auto render = [&](double view_x) {
    const SceneRendering rendering = scene.render({view_x, 0}, 0);
    return grey ? with_rows(to_grey(rendering.image), height_px)
                : with_rows(rendering.image, height_px);
  };
  TuningPair pair{render(0), render(1)};
  if (is_mirrored) {
    std::swap(pair.left, pair.right);
  }
  return pair;
}

TuningPair top_rows(const TuningPair& pair, int rows) {
  return {with_rows(pair.left, rows), with_rows(pair.right, rows)};
}

}  // namespace vantage
