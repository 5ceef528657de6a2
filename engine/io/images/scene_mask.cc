#include "engine/io/images/scene_mask.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "engine/error.h"
#include "engine/image/left_out.h"
#include "engine/io/images/black_border.h"
#include "engine/io/images/photograph_io.h"

namespace vantage {
namespace {

/// Adds the pixels of which `is_left_out` says so, given their channels.
template <typename IsLeftOut>
void add_pixels(const Photograph& photograph, const IsLeftOut& is_left_out, Mask& mask) {
  if (mask.empty()) {
    mask.resize(photograph.width(), photograph.height());
    mask.fill(0);
  }
  std::visit(
      [&](const auto& image) {
        for (int y = 0; y < mask.height(); ++y) {
          for (int x = 0; x < mask.width(); ++x) {
            if (is_left_out(image.row(y) + x * image.channels())) {
              mask.at(x, y) = 255;
            }
          }
        }
      },
      photograph.pixels);
}

/// `colour`: a grey level or R, G, B.
void add_colour(const Photograph& photograph, const std::vector<double>& colour, Mask& mask) {
  const int channels = std::min(3, photograph.channels());
  add_pixels(
      photograph,
      [&](const auto* pixel) {
        for (std::size_t c = 0; c < 3; ++c) {
          const auto value = static_cast<double>(pixel[channels == 3 ? c : 0]);
          if (value != colour[colour.size() == 3 ? c : 0]) {
            return false;
          }
        }
        return true;
      },
      mask);
}

}  // namespace

void SceneMaskOptions::validate() const {
  if (!no_data.empty() && no_data.size() != 1 && no_data.size() != 3) {
    throw UsageError(
        fmt::format("no-data has {} numbers, expected a grey level or R,G,B", no_data.size()));
  }
}

std::array<std::string, 2> SceneMaskOptions::files() const {
  return {left == kAlpha || left == kNone ? "" : left, right};
}

Mask black_pixels(const Photograph& picture) {
  Mask mask;
  add_colour(picture, {0}, mask);
  return mask;
}

void leave_out_of_pair(const SceneMaskOptions& options, std::array<Mask, 2> masks, Photograph& left,
                       Photograph& right) {
  for (const std::size_t i : {0, 1}) {
    Photograph& photograph = i == 0 ? left : right;
    const char* const name = i == 0 ? "left" : "right";
    Mask& mask = masks[i];
    if (!mask.empty() &&
        (mask.width() != photograph.width() || mask.height() != photograph.height())) {
      throw Error(fmt::format("the mask of the {} image is {}x{}, expected {}x{} as the image",
                              name, mask.width(), mask.height(), photograph.width(),
                              photograph.height()));
    }
    if (options.left == SceneMaskOptions::kAlpha) {
      if (photograph.channels() != 4) {
        throw Error(fmt::format("mask is alpha, but the {} image has {} channels, expected 4", name,
                                photograph.channels()));
      }
      add_pixels(
          photograph, [](const auto* pixel) { return pixel[3] == 0; }, mask);
    }
    if (!options.no_data.empty()) {
      add_colour(photograph, options.no_data, mask);
    }
    leave_out(photograph, std::move(mask));
  }
}

void leave_out_of_pair(const SceneMaskOptions& options, Photograph& left, Photograph& right) {
  std::array<Mask, 2> masks;
  if (options.finds_borders()) {
    masks = {black_border(left), black_border(right)};
  }
  for (const std::size_t i : {0, 1}) {
    if (const std::string file = options.files()[i]; !file.empty()) {
      masks[i] = black_pixels(read_photograph(file));
    }
  }
  leave_out_of_pair(options, std::move(masks), left, right);
}

}  // namespace vantage
