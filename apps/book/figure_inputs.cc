#include "apps/book/figure_inputs.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/disparity_io.h"
#include "engine/matching/range_estimation.h"
#include "engine/options/match_settings.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

/// Names of the photographs of a public data set. {} is a number.
struct PublicScenes {
  std::string_view name;
  std::string_view images;
  std::string_view truth;  ///< of the left image
  int left;                ///< numbers of the usual pair
  int right;
  /// Grey levels of the truth per pixel of disparity, by the width up to which it holds; 0: PFM.
  std::array<std::pair<int, int>, 3> scales;
};
constexpr int kAnyWidth = 1 << 20;

constexpr std::array kPublicScenes = {
    PublicScenes{"Middlebury 2001, tsukuba",
                 "scene1.row3.col{}",
                 "truedisp.row3.col3",
                 3,
                 4,
                 {{{kAnyWidth, 16}, {}, {}}}},
    PublicScenes{"Middlebury 2001, tsukuba", "im{}", "disp3", 3, 4, {{{kAnyWidth, 16}, {}, {}}}},
    PublicScenes{
        "Middlebury 2001 or 2003", "im{}", "disp2", 2, 6, {{{440, 8}, {640, 4}, {1000, 2}}}},
    PublicScenes{"Middlebury 2005 or 2006",
                 "view{}",
                 "disp1",
                 1,
                 5,
                 {{{500, 3}, {1000, 2}, {kAnyWidth, 1}}}},
    PublicScenes{"Middlebury 2014 or 2021", "im{}", "disp0", 0, 1, {{{kAnyWidth, 0}, {}, {}}}}};

/// The file of that name with any ending of a photograph or a map; empty: none.
fs::path find_image(const fs::path& folder, std::string_view name) {
  for (const char* const ending : {".png", ".ppm", ".pgm", ".pfm", ".jpg"}) {
    fs::path path = folder / fmt::format("{}{}", name, ending);
    if (fs::exists(path)) {
      return path;
    }
  }
  return {};
}

fs::path photograph_of(const fs::path& folder, const PublicScenes& scenes, int number) {
  return find_image(folder, fmt::format(fmt::runtime(scenes.images), number));
}

const PublicScenes& recognise(const fs::path& folder) {
  for (const PublicScenes& scenes : kPublicScenes) {
    if (!photograph_of(folder, scenes, scenes.left).empty() &&
        !photograph_of(folder, scenes, scenes.right).empty() &&
        !find_image(folder, scenes.truth).empty()) {
      return scenes;
    }
  }
  throw Error(fmt::format(
      "{}: no scene of Middlebury: expected images and truth such as im3, im4, disp3 (tsukuba), "
      "im2, im6, disp2 (2001, 2003), view1, view5, disp1 (2005, 2006) or im0, im1, disp0 (2014)",
      folder.string()));
}

int scale_of(const PublicScenes& scenes, int width) {
  for (const auto& [widest, scale] : scenes.scales) {
    if (width <= widest) {
      return scale;
    }
  }
  return 1;
}

FigureImages read_scene(const fs::path& folder) {
  constexpr int kMaxNumber = 9;
  const PublicScenes& scenes = recognise(folder);
  FigureImages images{
      .description = fmt::format("{} ({}), in place of the book's images, which are not public",
                                 folder.filename().string(), scenes.name),
      .left = read_photograph(photograph_of(folder, scenes, scenes.left)),
      .right = read_photograph(photograph_of(folder, scenes, scenes.right)),
      .disparities = {}};
  images.left_truth =
      read_disparity(find_image(folder, scenes.truth), scale_of(scenes, images.left.width()));
  std::map<double, fs::path> by_position;
  for (int number = 0; number <= kMaxNumber; ++number) {
    const double position =
        static_cast<double>(number - scenes.left) / (scenes.right - scenes.left);
    const fs::path path = photograph_of(folder, scenes, number);
    if (path.empty()) {
      continue;
    }
    by_position[position] = path;
    if (number != scenes.left && number != scenes.right) {
      Photograph other = read_photograph(path);
      if (other.width() == images.left.width() && other.height() == images.left.height()) {
        images.more.push_back(std::move(other));
        images.baselines.push_back(position);
      }
    }
  }
  images.view = [by_position](double view_x) {
    const auto found = by_position.find(view_x);
    return found == by_position.end() ? std::nullopt
                                      : std::optional(read_photograph(found->second));
  };
  return images;
}

FigureImages read_files(const FigureInputs& inputs) {
  FigureImages images{
      .description = fmt::format("{} and {}, in place of the book's images, which are not public",
                                 inputs.left, inputs.right),
      .left = read_photograph(inputs.left),
      .right = read_photograph(inputs.right),
      .disparities = {}};
  if (!inputs.truth.empty()) {
    images.left_truth = read_disparity(inputs.truth, inputs.truth_scale.value_or(0));
  }
  return images;
}

}  // namespace

void add_figure_input_settings(Settings& settings, FigureInputs& inputs) {
  settings.start_group("Photographs (instead of generated scenes, for figures of photographs)");
  settings.input_path("left", inputs.left, "FILE", "Left image of a rectified pair");
  settings.input_path("right", inputs.right, "FILE", "Right image of the same size");
  settings.input_path("truth", inputs.truth, "FILE", "True disparities of the left image");
  settings.number(
      "truth-scale", inputs.truth_scale, "S",
      "Divide values of an integer --truth by S; auto: 256 for 16-bit PNG; required for "
      "8-bit files");
  settings.input_path("data", inputs.data, "DIR",
                      "Folder of a public scene with truth, files named as Middlebury publishes "
                      "them, instead of --left, --right and --truth");
  Setting& disparities = settings.add("disparities", "MIN:MAX",
                                      "Disparities to search in these photographs; auto: found");
  disparities.set = [&inputs](const SettingValue& value) {
    inputs.disparities = is_word(value, "auto")
                             ? std::nullopt
                             : std::optional(to_disparity_range(
                                   value, "MIN:MAX in whole pixels, such as 0:63, or auto"));
  };
  disparities.get = [&inputs]() -> SettingValue {
    return inputs.disparities ? SettingValue(to_text(*inputs.disparities)) : SettingValue("auto");
  };
}

void check_figure_inputs(const FigureInputs& inputs, const Settings& settings) {
  if (inputs.left.empty() != inputs.right.empty()) {
    throw UsageError(fmt::format("--{0} is missing, expected --left and --right",
                                 inputs.left.empty() ? "left" : "right"));
  }
  if (!inputs.data.empty()) {
    settings.refuse_idle({"left", "right", "truth", "truth-scale"}, "with --data");
  } else if (inputs.left.empty()) {
    settings.refuse_idle({"truth", "truth-scale", "disparities"},
                         "without --left and --right, or --data");
  }
  require_above_0("truth-scale", inputs.truth_scale);
}

FigureImages read_figure_inputs(const FigureInputs& inputs, Execution& execution) {
  FigureImages images = inputs.data.empty() ? read_files(inputs) : read_scene(inputs.data);
  images.disparities = inputs.disparities
                           ? *inputs.disparities
                           : estimate_disparity_range(images.left, images.right, execution);
  return images;
}

}  // namespace vantage::apps
