#include "apps/pages/view_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/pages/embedded_files.h"
#include "apps/pages/page_template.h"
#include "engine/build_info.h"
#include "engine/error.h"
#include "engine/image/eight_bit.h"
#include "engine/io/files/encoded_text.h"
#include "engine/io/images/preview.h"
#include "engine/synthesis/view_synthesizer.h"
#include "engine/view_geometry/depth_resolution.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage::apps {
namespace {

constexpr int kMaxSide = 16384;  // the largest texture of nearly all graphics
constexpr int kLargestNumber = 65535;
constexpr double kCoarsestStepPx = 1.0 / 16;
constexpr double kFinestStepPx = 1.0 / 4096;
constexpr double kStepBesideJpegPx = 1.0 / 32;  // half the bytes, and nothing to be seen

void check_range(std::string_view option, const ViewRange& range) {
  if (!(range.first <= range.last && range.first >= -kMaxViewDistance &&
        range.last <= kMaxViewDistance)) {
    throw UsageError(
        fmt::format("{} is {}:{}, expected two numbers within ±{}, the smaller one first", option,
                    range.first, range.last, kMaxViewDistance));
  }
}

/// How the page stores disparities: as whole numbers 1..65535, 0 = unknown.
struct DisparityNumbers {
  double smallest_px = 0;  ///< of the number 1; a multiple of step_px
  double step_px = 1;      ///< a power of two
};

/// The first step from `finest_step_px` in which all known values of both maps can be stored.
DisparityNumbers choose_disparity_numbers(ImageView<const float> left, ImageView<const float> right,
                                          double finest_step_px) {
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  for (const ImageView<const float>& map : {left, right}) {
    for (int y = 0; y < map.height(); ++y) {
      for (int x = 0; x < map.width(); ++x) {
        const double d = map.at(x, y);
        if (std::isfinite(d)) {
          smallest = std::min(smallest, d);
          largest = std::max(largest, d);
        }
      }
    }
  }
  if (!(smallest <= largest)) {
    return {};
  }
  for (double step = finest_step_px; step <= kCoarsestStepPx; step *= 2) {
    const double begin = std::floor(smallest / step) * step;
    if ((largest - begin) / step <= kLargestNumber - 2) {
      return {.smallest_px = begin, .step_px = step};
    }
  }
  throw Error(
      fmt::format("disparities of the maps span {} to {} pixels, expected at most 4095 "
                  "from the smallest to the largest",
                  smallest, largest));
}

Image<std::uint8_t> as_numbers(ImageView<const float> map, const DisparityNumbers& numbers) {
  Image<std::uint8_t> result(map.width(), map.height(), 3);
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const double d = map.at(x, y);
      const int number =
          std::isfinite(d)
              ? 1 + static_cast<int>(std::lround((d - numbers.smallest_px) / numbers.step_px))
              : 0;
      result.at(x, y, 0) = static_cast<std::uint8_t>(number >> 8);
      result.at(x, y, 1) = static_cast<std::uint8_t>(number & 0xFF);
      result.at(x, y, 2) = 0;
    }
  }
  return result;
}

// All colours of a preview, from far to near.
Image<std::uint8_t> make_palette() {
  constexpr int kColours = 256;
  DisparityMap ramp(kColours, 1);
  for (int x = 0; x < kColours; ++x) {
    ramp.at(x, 0) = static_cast<float>(x);
  }
  return colour_preview(ramp.view(), 0, kColours - 1);
}

SettingValue intensity_of(const PairWithMaps& pair, const SynthesisOptions& options,
                          Execution& execution) {
  std::array<IntensityFit, 4> fits;
  const int channels = pair.left.channels();
  const ViewSynthesizer synthesizer(options, execution);
  // Called even if its result is not used: it checks that the pair and its maps fit together.
  const auto sums =
      synthesizer.intensity_sums({pair.left, pair.right, pair.maps.left.disparity_px.view(),
                                  pair.maps.right.disparity_px.view()},
                                 0.5);
  if (options.match_intensities) {
    fits = fit_channels(sums, channels, 1);
  }
  SettingValue offset = SettingValue::array();
  SettingValue gain = SettingValue::array();
  for (std::size_t c = 0; c < 3; ++c) {
    const IntensityFit& fit = fits[channels == 1 ? 0 : c];
    offset.push_back(fit.offset / 255);
    gain.push_back(fit.gain);
  }
  return {{"offset", offset}, {"gain", gain}};
}

std::string_view name_of(HoleFilling holes) {
  switch (holes) {
    case HoleFilling::kSpread:
      return "spread";
    case HoleFilling::kNone:
      return "none";
    case HoleFilling::kMirror:
      return "mirror";
    default:
      return "interpolate";
  }
}

/// What turns disparities of the left map into points: from the cameras, or else from a usual lens
/// with all disparities before infinity.
SettingValue cloud_of(const PairWithMaps& pair) {
  const DisparityMap& map = pair.maps.left.disparity_px;
  const DisparityQuantiles disparities =
      disparity_quantiles(map.view()).value_or(DisparityQuantiles{1, 1, 1});
  const auto median = static_cast<double>(disparities.median_px);
  const auto farthest = static_cast<double>(disparities.farthest_px);
  double focal_px = map.width();
  double doffs_px = 0;
  SettingValue centre = {(map.width() - 1) / 2.0, (map.height() - 1) / 2.0};
  if (pair.cameras) {
    const Eigen::Matrix3d& matrix = pair.cameras->left.matrix;
    focal_px = matrix(0, 0);
    doffs_px = pair.cameras->doffs_px;
    centre = {matrix(0, 2), matrix(1, 2)};
  }
  if (!pair.cameras || !(median + doffs_px > 0)) {
    constexpr double kNearerThanInfinity = 0.1;  // of the range
    const double margin = std::max(
        kNearerThanInfinity * static_cast<double>(disparities.nearest_px - disparities.farthest_px),
        0.5);
    doffs_px = std::max(doffs_px, margin - farthest);
  }
  return {{"focal", focal_px},
          {"centre", centre},
          {"doffs", doffs_px},
          {"pivotDisparity", median},
          {"calibrated", pair.cameras.has_value()}};
}

/// What all frames of a page have in common; `pair` is the first.
SettingValue scene_of(const PairWithMaps& pair, const ViewPageOptions& options) {
  const int width = pair.left.width();
  const int height = pair.left.height();
  if (std::max(width, height) > kMaxSide) {
    throw Error(
        fmt::format("left image is {}×{}, expected at most {} pixels on a side: graphics "
                    "of browsers draw no larger",
                    width, height, kMaxSide));
  }
  const SynthesisOptions& synthesis = options.synthesis;
  return {{"width", width},
          {"height", height},
          {"rangeX", {options.range_x.first, options.range_x.last}},
          {"rangeY", {options.range_y.first, options.range_y.last}},
          {"cloud", cloud_of(pair)},
          {"gradientLimit", synthesis.disparity_gradient_limit_px},
          {"gamma", synthesis.gamma ? SettingValue(*synthesis.gamma) : SettingValue()},
          {"holes", name_of(synthesis.holes)},
          {"softEdges", synthesis.soft_edges}};
}

std::string shader_elements() {
  std::string result;
  for (const std::string_view name :
       {"disparity.glsl", "warp.vert", "warp.frag", "screen.vert", "combine.frag", "fill.frag",
        "interpolate.frag", "soften.frag", "outlines.frag", "rows.frag", "show.frag", "cloud.vert",
        "cloud.frag", "headset.vert"}) {
    result += fmt::format("<script type=\"text/plain\" id=\"{}\">\n{}</script>\n", name,
                          embedded_file(fmt::format("view_page/{}", name)));
  }
  return result;
}

}  // namespace

void ViewPageOptions::validate() const {
  check_range("--range", range_x);
  check_range("--vertical-range", range_y);
  synthesis.validate();
}

ViewPage::ViewPage(ViewPageOptions options, std::string folder, PictureEncoder encode)
    : options_(std::move(options)),
      is_lossless_(options_.images.value_or(
                       folder.empty() ? PageImages::kPng : PageImages::kJpeg) == PageImages::kPng),
      folder_(std::move(folder)),
      encode_(std::move(encode)) {
  options_.validate();
}

std::string ViewPage::add_frame(int number, const PairWithMaps& pair, Execution& execution) {
  const SettingValue intensity = intensity_of(pair, options_.synthesis, execution);
  const ImageView<const float> left_map = pair.maps.left.disparity_px.view();
  const ImageView<const float> right_map = pair.maps.right.disparity_px.view();
  const PreviewRange colours = choose_preview_range(left_map);
  if (scene_.is_null()) {
    scene_ = scene_of(pair, options_);
    colours_ = colours;
  }
  if (scene_["width"] != pair.left.width() || scene_["height"] != pair.left.height()) {
    throw Error(fmt::format("frame {} is {}×{}, expected {}×{} as the frames before it", number,
                            pair.left.width(), pair.left.height(), scene_["width"].get<int>(),
                            scene_["height"].get<int>()));
  }
  colours_ = {std::min(colours_.min_px, colours.min_px), std::max(colours_.max_px, colours.max_px)};
  const DisparityNumbers numbers = choose_disparity_numbers(
      left_map, right_map, is_lossless_ ? kFinestStepPx : kStepBesideJpegPx);
  const std::string image = is_lossless_ ? "image.png" : "image.jpg";
  std::array<std::string, 4> pictures;
  execution.executor().parallel_for(4, [&](int k) {
    pictures[static_cast<std::size_t>(k)] =
        k < 2 ? encode_(image, eight_bit(k == 0 ? pair.left : pair.right))
              : encode_("map.png", as_numbers(k == 2 ? left_map : right_map, numbers));
  });
  frames_.push_back({{"number", number}, {"problem", ""}});
  const SettingValue frame = {
      {"disparity", {{"smallest", numbers.smallest_px}, {"step", numbers.step_px}}},
      {"intensity", intensity},
      {"type", is_lossless_ ? "image/png" : "image/jpeg"},
      {"left", std::move(pictures[0])},
      {"right", std::move(pictures[1])},
      {"leftMap", std::move(pictures[2])},
      {"rightMap", std::move(pictures[3])}};
  return fmt::format("Film.deliver({}, {});\n", number, frame.dump());
}

void ViewPage::add_missing(int number, const std::string& problem) {
  frames_.push_back({{"number", number}, {"problem", problem}});
}

std::string ViewPage::script_name(int number) { return fmt::format("{:06}.js", number); }

std::string ViewPage::html(const std::string& names, FrameRate rate,
                           const std::string& script) const {
  SettingValue scene = scene_;
  scene["paletteRange"] = {colours_.min_px, colours_.max_px};
  scene["film"] = {{"folder", folder_}, {"frames", frames_}, {"rate", rate.per_second()}};
  return filled_in(embedded_file("view_page/page.html"),
                   {{"title", escaped_markup(names + " – Vantage")},
                    {"names", escaped_markup(names)},
                    {"version", build_info().version},
                    {"style", std::string(embedded_file("view_page/page.css"))},
                    {"script_sources", folder_.empty() ? "" : " 'self' file:"},
                    {"palette", encode_("palette.png", make_palette())},
                    {"scene", json_in_html(scene.dump())},
                    {"shaders", shader_elements()},
                    {"renderer", std::string(embedded_file("view_page/renderer.js"))},
                    {"orbit", std::string(embedded_file("view_page/orbit.js"))},
                    {"film", std::string(embedded_file("view_page/film.js"))},
                    {"frame", script},
                    {"headset", std::string(embedded_file("view_page/headset.js"))},
                    {"script", std::string(embedded_file("view_page/page.js"))}});
}

}  // namespace vantage::apps
