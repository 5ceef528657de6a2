#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/evaluation/cumulative_response.h"
#include "engine/evaluation/evidence_image.h"
#include "engine/evaluation/method_comparison.h"
#include "engine/evaluation/rms_differences.h"
#include "engine/figures/figure_families.h"
#include "engine/figures/figure_images.h"
#include "engine/figures/scene_maps.h"
#include "engine/plot/heat_map.h"

namespace vantage {
namespace {

// The book's range of displacements, for images of this width.
constexpr DisparityRange kDisplacementsX = {-40, 50};
constexpr DisparityRange kDisplacementsY = {-20, 20};
constexpr double kRangeWidth = 360;

MethodParameters gradient_parameters(const FigureSettings& settings) {
  return compared_options(compared_method("gradient"), BookPattern::kGrass, 0, settings.parameters)
      .resolved();
}

DisparityRange scaled_range(DisparityRange range, int width) {
  const double scale = std::min(1.0, width / kRangeWidth);
  return {static_cast<int>(std::floor(range.min * scale)),
          static_cast<int>(std::ceil(range.max * scale))};
}

CumulativeResponse response_of(const FigureImages& images, const FigureRun& run) {
  CumulativeResponseOptions options;
  options.displacements_x = scaled_range(kDisplacementsX, images.left.width());
  options.displacements_y = scaled_range(kDisplacementsY, images.left.width());
  options.parameters = gradient_parameters(run.settings);
  return cumulative_response(images.left, images.right, options, run.execution);
}

std::string text_of(const std::optional<Displacement>& displacement) {
  return displacement ? fmt::format("({}, {})", displacement->x_px, displacement->y_px) : "none";
}

/// Mean truth of a quadrant, the displacement to expect there.
std::string mean_truth(const FigureImages& images, ImagePart part) {
  if (!images.left_truth) {
    return "";
  }
  const bool is_right = part == ImagePart::kTopRight || part == ImagePart::kBottomRight;
  const bool is_below = part == ImagePart::kBottomLeft || part == ImagePart::kBottomRight;
  const int width = images.left.width() / 2;
  const int height = images.left.height() / 2;
  double sum = 0;
  int count = 0;
  for (int y = is_below ? height : 0; y < (is_below ? 2 * height : height); ++y) {
    for (int x = is_right ? width : 0; x < (is_right ? 2 * width : width); ++x) {
      const float d = images.left_truth->at(x, y);
      if (std::isfinite(d)) {
        sum += double{d};
        ++count;
      }
    }
  }
  return count > 0 ? fmt::format("; mean true disparity {:.1f}", sum / count) : "";
}

FigureContent make_evidence_images(const FigureRun& run) {
  constexpr std::array<std::string_view, 5> kInTheBook = {"", "(-1, 1)", "(3, -2)", "(11, -2)",
                                                          "(15, -1)"};
  constexpr float kShownEvidence = 40;  // white, and with the other sign black
  const auto images = images_of(BookImages::kStreet, run);
  const CumulativeResponse response = response_of(*images, run);
  FigureContent content{.images = images->description};
  FigureTable table{"", {"quadrant", "dx_px", "dy_px", "evidence_per_pixel"}};
  std::vector<SheetPicture> pictures;
  for (const ImagePart part : {ImagePart::kTopLeft, ImagePart::kTopRight, ImagePart::kBottomLeft,
                               ImagePart::kBottomRight}) {
    const std::string name(kImagePartNames[static_cast<std::size_t>(part)]);
    const auto dominant = response.dominant(part);
    content.comparisons.push_back(
        {fmt::format("displacement of the {} quadrant (the order in the book is not printed)",
                     name),
         std::string(kInTheBook[static_cast<std::size_t>(part)]),
         text_of(dominant) + mean_truth(*images, part)});
    if (!dominant) {
      continue;
    }
    const Image<float> evidence = evidence_image(images->left, images->right, *dominant,
                                                 gradient_parameters(run.settings), run.execution);
    pictures.push_back(
        {fmt::format("{}: {}", name, text_of(dominant)),
         grey_picture(evidence.view(), -kShownEvidence, kShownEvidence, {128, 128, 128})});
    table.add(name, dominant->x_px, dominant->y_px,
              fmt::format("{:.6f}", response.at(part, *dominant) / response.pixels(part)));
  }
  content.pictures.push_back(
      {"", draw_picture_sheet(
               "Evidence for the displacement of the largest response in each quadrant: light is "
               "for, dark against a match",
               pictures, 2, 360)});
  content.tables.push_back(std::move(table));
  return content;
}

/// Values over displacements.
struct ResponseSurface {
  Image<float> values;
  Displacement peak;
  double peak_deviations = 0;  ///< height of the peak above the mean, in standard deviations
  double near_peak_percent =
      0;  ///< of all displacements, above half the peak's height over the mean
};

/// `value(index)`: of the displacement of that index; only displacements for which at least half of
/// the pixels have a partner count.
template <typename Value>
ResponseSurface surface_of(const FigureImages& images, DisparityRange range_x,
                           DisparityRange range_y, const Value& value) {
  ResponseSurface surface{.values = Image<float>(range_x.count(), range_y.count()), .peak = {}};
  const double width = images.left.width();
  const double height = images.left.height();
  std::vector<double> known;
  double best = -std::numeric_limits<double>::infinity();
  for (int y = 0; y < surface.values.height(); ++y) {
    for (int x = 0; x < surface.values.width(); ++x) {
      const Displacement displacement{range_x.min + x, range_y.min + y};
      const double here =
          value(static_cast<std::size_t>(y) * static_cast<std::size_t>(range_x.count()) +
                static_cast<std::size_t>(x));
      surface.values.at(x, y) = static_cast<float>(here);
      const double overlap = (width - std::abs(displacement.x_px)) *
                             (height - std::abs(displacement.y_px)) / (width * height);
      if (overlap >= 0.5 && std::isfinite(here)) {
        known.push_back(here);
        if (here > best) {
          best = here;
          surface.peak = displacement;
        }
      }
    }
  }
  double mean = 0;
  for (const double here : known) {
    mean += here / static_cast<double>(known.size());
  }
  double variance = 0;
  for (const double here : known) {
    variance += (here - mean) * (here - mean) / static_cast<double>(known.size());
  }
  surface.peak_deviations = (best - mean) / std::sqrt(variance);
  const auto near =
      std::ranges::count_if(known, [&](double here) { return here > mean + (best - mean) / 2; });
  surface.near_peak_percent = 100.0 * static_cast<double>(near) / static_cast<double>(known.size());
  return surface;
}

std::string discrimination_of(const ResponseSurface& surface) {
  return fmt::format(
      "peak {:.1f} standard deviations above the mean, {:.2f} % of the displacements above half "
      "its height",
      surface.peak_deviations, surface.near_peak_percent);
}

/// Both surfaces: each figure compares itself with the other one.
struct ResponseSurfaces {
  DisparityRange range_x;
  DisparityRange range_y;
  ResponseSurface evidence;
  ResponseSurface negated_rms;
};

ResponseSurfaces surfaces_of(const FigureImages& images, const FigureRun& run) {
  const CumulativeResponse response = response_of(images, run);
  const std::vector<double> rms = rms_differences(
      images.left, images.right, response.displacements_x, response.displacements_y, run.execution);
  const std::vector<double>& sums = response.surfaces[static_cast<std::size_t>(ImagePart::kWhole)];
  const double pixels = response.pixels(ImagePart::kWhole);
  return {response.displacements_x, response.displacements_y,
          surface_of(images, response.displacements_x, response.displacements_y,
                     [&](std::size_t index) { return sums[index] / pixels; }),
          surface_of(images, response.displacements_x, response.displacements_y,
                     [&](std::size_t index) { return -rms[index]; })};
}

/// Figs. 5.5 and 5.6: one of both surfaces, compared with the other one.
FigureContent make_surface(ResponseSurface ResponseSurfaces::*shown, const std::string& title,
                           const std::string& unit, const FigureRun& run) {
  const auto images = images_of(BookImages::kStreet, run);
  const ResponseSurfaces both = surfaces_of(*images, run);
  const ResponseSurface& surface = both.*shown;
  FigureContent content{.images = images->description};
  std::vector<HeatMap> maps;
  maps.push_back({.title = unit,
                  .x_title = "dx = x_left - x_right, pixels",
                  .y_title = "dy = y_left - y_right, pixels",
                  .x_first = both.range_x.min,
                  .y_first = both.range_y.min,
                  .values = surface.values.copy(),
                  .marked = {{surface.peak.x_px, surface.peak.y_px}}});
  content.pictures.push_back({"levels", draw_heat_maps(title, maps, 1)});
  FigureTable table{"", {"dx_px", "dy_px", "evidence_per_pixel", "negated_rms_grey_levels"}};
  for (int y = 0; y < surface.values.height(); ++y) {
    for (int x = 0; x < surface.values.width(); ++x) {
      table.add(both.range_x.min + x, both.range_y.min + y,
                fmt::format("{:.6g}", both.evidence.values.at(x, y)),
                fmt::format("{:.6g}", both.negated_rms.values.at(x, y)));
    }
  }
  content.tables.push_back(std::move(table));
  content.comparisons = {
      {"peak of the evidence and of the negated RMS", "both at roughly the same, (0, 0)",
       fmt::format("{} and {}", text_of(both.evidence.peak), text_of(both.negated_rms.peak))},
      {"evidence", "clearly more discriminatory", discrimination_of(both.evidence)},
      {"negated RMS", "clearly less discriminatory", discrimination_of(both.negated_rms)}};
  return content;
}

}  // namespace

std::vector<BookFigure> response_figures() {
  const FigureSettings street = {.size_px = default_width(BookImages::kStreet), .seed = 1};
  return {
      {.key = "5.3",
       .section = "5.5.1",
       .title = "The pair street",
       .book = "Left and right image: large areas without texture, cameras of different "
               "brightness, not rectified.",
       .defaults = street,
       .images = BookImages::kStreet,
       .make =
           [](const FigureRun& run) {
             return show_pair(BookImages::kStreet, "Unrectified pair", {"left", "right"}, 360, run);
           }},
      {.key = "5.4",
       .section = "5.5.1",
       .title = "Evidence for the dominant displacements",
       .book = "Grey-level plots of the evidence for the four displacements whose sum is "
               "largest in a quadrant: (-1, 1), (3, -2), (11, -2) and (15, -1). Light is for, "
               "dark against a match; most regions are grey.",
       .defaults = street,
       .method = "gradient",
       .images = BookImages::kStreet,
       .make = make_evidence_images},
      {.key = "5.5",
       .section = "5.5.1",
       .title = "Cumulative response over the image",
       .book = "Surface of the summed evidence for dx = -40..50 and dy = -20..20. The strongest "
               "peak is at roughly (0, 0); a ridge of horizontal displacements keeps epipolar "
               "lines aligned.",
       .defaults = street,
       .method = "gradient",
       .images = BookImages::kStreet,
       .make =
           [](const FigureRun& run) {
             return make_surface(&ResponseSurfaces::evidence, "Cumulative response",
                                 "evidence per pixel, grey levels", run);
           }},
      {.key = "5.6",
       .section = "5.5.1",
       .title = "Negated root-mean-square difference over the image",
       .book = "The same range with squared differences: clearly less discriminatory.",
       .defaults = street,
       .method = "gradient",
       .images = BookImages::kStreet,
       .make = [](const FigureRun& run) {
         return make_surface(&ResponseSurfaces::negated_rms, "Negated root-mean-square difference",
                             "negated RMS difference, grey levels", run);
       }}};
}

}  // namespace vantage
