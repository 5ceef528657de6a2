#include "engine/image/scene_mask.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>

#include "engine/error.h"
#include "engine/image/black_border.h"
#include "engine/image/intensity_rows.h"
#include "engine/image/left_out.h"

namespace vantage {
namespace {

constexpr std::array<std::string_view, 2> kNames = {"left", "right"};

bool has_size_of(const Mask& mask, const Photograph& photograph) {
  return mask.width() == photograph.width() && mask.height() == photograph.height();
}

/// The pixels of which `is_left_out` says so, given their channels.
template <typename IsLeftOut>
Mask pixels_where(const Photograph& photograph, const IsLeftOut& is_left_out) {
  Mask mask(photograph.width(), photograph.height());
  std::visit(
      [&](const auto& image) {
        for (int y = 0; y < mask.height(); ++y) {
          for (int x = 0; x < mask.width(); ++x) {
            mask.at(x, y) = is_left_out(image.row(y) + x * image.channels()) ? 255 : 0;
          }
        }
      },
      photograph.pixels);
  return mask;
}

Mask transparent_pixels(const Photograph& photograph, std::string_view name) {
  if (photograph.channels() != 4) {
    throw Error(
        fmt::format("mask is alpha, but the {} image has none, expected a picture with "
                    "four channels",
                    name));
  }
  return pixels_where(photograph, [](const auto* pixel) { return pixel[3] == 0; });
}

Mask pixels_of_colour(const Photograph& photograph, const std::vector<double>& colour) {
  const std::size_t colours = photograph.channels() == 1 ? 1 : 3;
  return pixels_where(photograph, [&](const auto* pixel) {
    for (std::size_t c = 0; c < std::max(colours, colour.size()); ++c) {
      const double level = colour[std::min(c, colour.size() - 1)];
      if (std::abs(static_cast<double>(pixel[std::min(c, colours - 1)]) - level) > 1e-6) {
        return false;
      }
    }
    return true;
  });
}

}  // namespace

void SceneMaskOptions::validate() const {
  const bool is_finite =
      std::ranges::all_of(no_data, [](double level) { return std::isfinite(level); });
  if (!is_finite || (!no_data.empty() && no_data.size() != 1 && no_data.size() != 3)) {
    throw UsageError(
        fmt::format("no-data has {} numbers, expected a grey level or R,G,B", no_data.size()));
  }
}

const std::string& SceneMaskOptions::file(std::size_t image) const {
  static const std::string no_file;
  return image == 1 ? right : left == kAlpha || left == kNone ? no_file : left;
}

Mask black_pixels(const Photograph& picture) {
  Mask mask(picture.width(), picture.height());
  std::vector<float> grey(static_cast<std::size_t>(picture.width()));
  for (int y = 0; y < picture.height(); ++y) {
    intensity_row(picture, y, grey.data());
    for (int x = 0; x < picture.width(); ++x) {
      mask.at(x, y) = grey[static_cast<std::size_t>(x)] > 0 ? 0 : 255;
    }
  }
  return mask;
}

void leave_out_of_pair(const SceneMaskOptions& options,
                       const std::array<const Photograph*, 2>& files,
                       const std::array<Mask, 2>* borders, Photograph& left, Photograph& right) {
  std::array<Mask, 2> found;
  if (borders == nullptr) {
    if (options.finds_borders()) {
      found = black_borders(left, right);
    }
    borders = &found;
  }
  for (const std::size_t i : {0, 1}) {
    Photograph& photograph = i == 0 ? left : right;
    Mask mask;
    if (files[i] != nullptr) {
      mask = black_pixels(*files[i]);
      if (!has_size_of(mask, photograph)) {
        throw Error(fmt::format("the mask of the {} image is {}x{}, expected {}x{} as the image",
                                kNames[i], mask.width(), mask.height(), photograph.width(),
                                photograph.height()));
      }
    }
    if (options.uses_alpha()) {
      mask = of_either(std::move(mask), transparent_pixels(photograph, kNames[i]));
    }
    if (!options.no_data.empty()) {
      mask = of_either(std::move(mask), pixels_of_colour(photograph, options.no_data));
    }
    if (options.finds_borders() && has_size_of((*borders)[i], photograph)) {
      mask = of_either(std::move(mask), (*borders)[i]);
    }
    leave_out(photograph, share_of(mask) > 0 ? std::move(mask) : Mask());
  }
}

}  // namespace vantage
