#include "apps/book/response_drawings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "engine/evaluation/evidence_image.h"
#include "engine/order_statistics.h"
#include "engine/plot/heat_map.h"
#include "engine/plot/line_plot.h"
#include "engine/plot/picture_sheet.h"

namespace vantage::apps {
namespace {

constexpr int kResponseParts = static_cast<int>(kImagePartNames.size());

Drawing draw_curves(const CumulativeResponse& response, std::span<const double> rms) {
  const bool along_x = response.displacements_y.count() == 1;
  const DisparityRange range = along_x ? response.displacements_x : response.displacements_y;
  LinePlot plot{.title = along_x ? fmt::format("dy = {}", response.displacements_y.min)
                                 : fmt::format("dx = {}", response.displacements_x.min),
                .x_axis = {.title = along_x ? "dx = x_left - x_right, pixels"
                                            : "dy = y_left - y_right, pixels"},
                .y_axis = {.title = "evidence per pixel, grey levels"},
                .markers = false,
                .series = {}};
  for (int part = 0; part < kResponseParts; ++part) {
    const auto index = static_cast<std::size_t>(part);
    PlotSeries series{std::string(kImagePartNames[index]), {}, {}};
    const double pixels = response.pixels(static_cast<ImagePart>(part));
    for (int i = 0; i < range.count(); ++i) {
      series.x.push_back(range.min + i);
      series.y.push_back(response.surfaces[index][static_cast<std::size_t>(i)] / pixels);
    }
    plot.series.push_back(std::move(series));
  }
  std::vector<LinePlot> plots = {plot};
  if (!rms.empty()) {
    PlotSeries series{"whole", {}, {}};
    for (int i = 0; i < range.count(); ++i) {
      series.x.push_back(range.min + i);
      series.y.push_back(-rms[static_cast<std::size_t>(i)]);
    }
    plot.y_axis.title = "negated RMS difference, grey levels";
    plot.series = {series};
    plots.push_back(std::move(plot));
  }
  return draw_line_plots("Cumulative response", plots, 1);
}

Drawing draw_surfaces(const CumulativeResponse& response, std::span<const double> rms) {
  std::vector<HeatMap> maps;
  for (int part = 0; part < kResponseParts; ++part) {
    const auto index = static_cast<std::size_t>(part);
    const double pixels = response.pixels(static_cast<ImagePart>(part));
    HeatMap map{
        .title = std::string(kImagePartNames[index]),
        .x_title = "dx = x_left - x_right, pixels",
        .y_title = "dy = y_left - y_right, pixels; colour: evidence per pixel",
        .x_first = response.displacements_x.min,
        .y_first = response.displacements_y.min,
        .values = Image<float>(response.displacements_x.count(), response.displacements_y.count())};
    auto value = response.surfaces[index].begin();
    for (int y = 0; y < map.values.height(); ++y) {
      for (int x = 0; x < map.values.width(); ++x) {
        map.values.at(x, y) = static_cast<float>(*value++ / pixels);
      }
    }
    if (const auto dominant = response.dominant(static_cast<ImagePart>(part))) {
      map.marked = {dominant->x_px, dominant->y_px};
      map.title += fmt::format(": largest at {}, {}", dominant->x_px, dominant->y_px);
    }
    maps.push_back(std::move(map));
  }
  if (!rms.empty()) {
    HeatMap map{
        .title = "negated RMS difference",
        .x_title = "dx = x_left - x_right, pixels",
        .y_title = "dy = y_left - y_right, pixels; colour: grey levels",
        .x_first = response.displacements_x.min,
        .y_first = response.displacements_y.min,
        .values = Image<float>(response.displacements_x.count(), response.displacements_y.count())};
    auto value = rms.begin();
    for (int y = 0; y < map.values.height(); ++y) {
      for (int x = 0; x < map.values.width(); ++x) {
        map.values.at(x, y) = static_cast<float>(-*value++);
      }
    }
    if (const auto smallest = smallest_rms(response, rms)) {
      map.marked = {smallest->displacement.x_px, smallest->displacement.y_px};
      map.title += fmt::format(": largest at {}, {}", smallest->displacement.x_px,
                               smallest->displacement.y_px);
    }
    maps.push_back(std::move(map));
  }
  constexpr int kColumns = 3;
  return draw_heat_maps("Cumulative response", maps, kColumns);
}

/// The smallest limit that holds all but a hundredth of the evidence.
float shown_evidence(const std::vector<Image<float>>& images) {
  std::vector<float> magnitudes;
  for (const Image<float>& image : images) {
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        if (std::isfinite(image.at(x, y))) {
          magnitudes.push_back(std::abs(image.at(x, y)));
        }
      }
    }
  }
  if (magnitudes.empty()) {
    return 1;
  }
  const auto rank = static_cast<std::size_t>(0.99 * static_cast<double>(magnitudes.size() - 1));
  return std::max(value_of_rank(magnitudes, rank), 1e-6F);
}

}  // namespace

std::optional<SmallestRms> smallest_rms(const CumulativeResponse& response,
                                        std::span<const double> rms) {
  std::optional<SmallestRms> smallest;
  const int columns = response.displacements_x.count();
  for (std::size_t i = 0; i < rms.size(); ++i) {
    const Displacement at{response.displacements_x.min + static_cast<int>(i) % columns,
                          response.displacements_y.min + static_cast<int>(i) / columns};
    const double columns_with = std::max(0, response.width_px - std::abs(at.x_px));
    const double rows_with = std::max(0, response.height_px - std::abs(at.y_px));
    if (2 * columns_with * rows_with >= response.pixels(ImagePart::kWhole) &&
        (!smallest || rms[i] < smallest->rms)) {
      smallest = {at, rms[i]};
    }
  }
  return smallest;
}

Drawing draw_response(const CumulativeResponse& response, std::span<const double> rms) {
  const bool one_range =
      response.displacements_x.count() == 1 || response.displacements_y.count() == 1;
  return one_range ? draw_curves(response, rms) : draw_surfaces(response, rms);
}

Drawing draw_evidence(const CumulativeResponse& response, const Photograph& left,
                      const Photograph& right, const MethodParameters& parameters,
                      Execution& execution) {
  std::vector<Image<float>> images;
  std::vector<std::string> titles;
  for (int part = 0; part < kResponseParts; ++part) {
    const auto dominant = response.dominant(static_cast<ImagePart>(part));
    if (dominant) {
      titles.push_back(fmt::format("{}: {}, {}", kImagePartNames[static_cast<std::size_t>(part)],
                                   dominant->x_px, dominant->y_px));
      images.push_back(evidence_image(left, right, *dominant, parameters, execution));
    }
  }
  const float limit = shown_evidence(images);
  std::vector<SheetPicture> pictures;
  for (std::size_t i = 0; i < images.size(); ++i) {
    pictures.push_back(
        {titles[i], grey_picture(std::as_const(images[i]).view(), -limit, limit, {128, 128, 128})});
  }
  constexpr int kColumns = 3;
  constexpr double kWidth = 360;
  return draw_picture_sheet(
      fmt::format("Evidence for the displacements of the largest sums, white: {:.3g} grey levels",
                  limit),
      pictures, kColumns, kWidth);
}

}  // namespace vantage::apps
