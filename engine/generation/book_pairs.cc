#include "engine/generation/book_pairs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/generation/option_range.h"
#include "engine/generation/portable_random.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

constexpr int kMaxDisparityPx = 4096;
constexpr double kRampSlopePerPx = 2.5;
constexpr double kRandomDotLevels[] = {64, 192};
constexpr double kGrassMean = 112;
constexpr double kGrassDeviation = 22;
constexpr int kSearchMarginPx = 3;

// Random streams of one seed. Textures use kTextureStream and the following ones.
enum Stream : std::uint64_t { kLeftNoiseStream, kRightNoiseStream, kTextureStream };

// A fronto-parallel rectangle, half-open, on the grid of the reference image.
struct Layer {
  int disparity_px;
  int x_begin, x_end;
  int y_begin, y_end;
};

int fraction_of(int size, double fraction) {
  return static_cast<int>(std::lround(size * fraction));
}

// Nearest first. The background comes last and is unbounded.
std::vector<Layer> make_layers(const BookPairOptions& options) {
  const int width = options.width_px;
  const int height = options.height_px;
  const int front = options.front_disparity_or_default();
  std::vector<Layer> layers;
  if (options.shape == BookShape::kSquare) {
    const int x = fraction_of(width, 0.3);
    const int y = fraction_of(height, 0.3);
    layers.push_back({front, x, x + fraction_of(width, 0.4), y, y + fraction_of(height, 0.4)});
  } else {
    const int narrow = options.narrow_disparity_or_default();
    // The displacement against the background must exceed twice the width.
    const int widest = std::max(1, (narrow - options.background_disparity_px - 1) / 2);
    const int bar_width = std::clamp(fraction_of(width, 0.06), 1, widest);
    const int bar_x = fraction_of(width, 0.5) - bar_width / 2;
    layers.push_back(
        {narrow, bar_x, bar_x + bar_width, fraction_of(height, 0.55), fraction_of(height, 0.9)});
    const int x = fraction_of(width, 0.35);
    const int y = fraction_of(height, 0.1);
    layers.push_back({front, x, x + fraction_of(width, 0.3), y, y + fraction_of(height, 0.35)});
  }
  const int far_out = width + 2 * kMaxDisparityPx;
  layers.push_back({options.background_disparity_px, -far_out, far_out, 0, height});
  return layers;
}

// Shift from a position on the reference grid to the position x of the same point of a layer on
// `grid`.
int shift_to_reference(const Layer& layer, Side grid, Side reference) {
  if (grid == reference) {
    return 0;
  }
  return reference == Side::kLeft ? layer.disparity_px : -layer.disparity_px;
}

// Index of the nearest layer at each pixel of `grid`.
Image<std::uint8_t> visible_layers(const std::vector<Layer>& layers, const BookPairOptions& options,
                                   Side grid) {
  Image<std::uint8_t> visible(options.width_px, options.height_px);
  for (int y = 0; y < options.height_px; ++y) {
    for (int x = 0; x < options.width_px; ++x) {
      const auto nearest = std::find_if(layers.begin(), layers.end(), [&](const Layer& layer) {
        const int layer_x = x + shift_to_reference(layer, grid, options.reference);
        return layer_x >= layer.x_begin && layer_x < layer.x_end && y >= layer.y_begin &&
               y < layer.y_end;
      });
      visible.at(x, y) = static_cast<std::uint8_t>(nearest - layers.begin());
    }
  }
  return visible;
}

DisparityMap disparities_of(const std::vector<Layer>& layers, const Image<std::uint8_t>& visible) {
  DisparityMap map(visible.width(), visible.height());
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      map.at(x, y) = static_cast<float>(layers[visible.at(x, y)].disparity_px);
    }
  }
  return map;
}

// `partner_step` is −1 from left to right and +1 from right to left.
Mask occluded_pixels(const std::vector<Layer>& layers, const Image<std::uint8_t>& visible,
                     const Image<std::uint8_t>& visible_in_other, int partner_step) {
  Mask occluded(visible.width(), visible.height());
  for (int y = 0; y < visible.height(); ++y) {
    for (int x = 0; x < visible.width(); ++x) {
      const int layer = visible.at(x, y);
      const int partner = x + partner_step * layers[static_cast<std::size_t>(layer)].disparity_px;
      const bool seen =
          partner >= 0 && partner < visible.width() && visible_in_other.at(partner, y) == layer;
      occluded.at(x, y) = seen ? 0 : 255;
    }
  }
  return occluded;
}

// The infinite texture of one layer, cropped to the columns that either image can show.
class Texture {
 public:
  Texture(const BookPairOptions& options, int first_x, int end_x, std::uint64_t stream)
      : first_x_(first_x), values_(end_x - first_x, options.height_px) {
    PortableRandom random(options.seed, stream);
    if (options.pattern == BookPattern::kRandomDots) {
      for (int y = 0; y < values_.height(); ++y) {
        std::generate_n(values_.row(y), values_.width(), [&] {
          return static_cast<float>(kRandomDotLevels[random.uniform() < 0.5 ? 0 : 1]);
        });
      }
    } else {
      fill_with_grass(random);
    }
  }
  [[nodiscard]] double at(int x, int y) const { return values_.at(x - first_x_, y); }

 private:
  // White noise filtered by a small kernel that is elongated along y, like blades. The kernel's
  // squares sum to one, so the variance is that of the white noise.
  void fill_with_grass(PortableRandom& random) {
    constexpr int kRadiusX = 1;
    constexpr int kRadiusY = 2;
    constexpr double kKernelX[] = {0.3, 1, 0.3};
    constexpr double kKernelY[] = {0.35, 0.8, 1, 0.8, 0.35};
    double squares = 0;
    for (const double ky : kKernelY) {
      for (const double kx : kKernelX) {
        squares += ky * ky * kx * kx;
      }
    }
    const double gain = kGrassDeviation / std::sqrt(squares);
    Image<float> white(values_.width() + 2 * kRadiusX, values_.height() + 2 * kRadiusY);
    for (int y = 0; y < white.height(); ++y) {
      std::generate_n(white.row(y), white.width(),
                      [&] { return static_cast<float>(random.normal()); });
    }
    for (int y = 0; y < values_.height(); ++y) {
      for (int x = 0; x < values_.width(); ++x) {
        double sum = 0;
        for (int j = 0; j <= 2 * kRadiusY; ++j) {
          for (int i = 0; i <= 2 * kRadiusX; ++i) {
            sum += kKernelY[j] * kKernelX[i] * static_cast<double>(white.at(x + i, y + j));
          }
        }
        values_.at(x, y) = static_cast<float>(kGrassMean + gain * sum);
      }
    }
  }

  int first_x_;
  Image<float> values_;
};

// Grey levels of both images, before noise.
struct Intensities {
  Image<float> left;
  Image<float> right;
};

// The ramp has no separate texture per layer: the reference image samples the other one, where the
// ramp is unbroken.
Intensities make_ramp(const BookPairOptions& options, const std::vector<Layer>& layers,
                      const Image<std::uint8_t>& visible_in_reference) {
  const int step = direction_of(options.reference);
  const auto partner_of = [&](int x, int y) {
    return x + step * layers[visible_in_reference.at(x, y)].disparity_px;
  };
  int first = 0;
  int last = options.width_px - 1;
  for (int y = 0; y < options.height_px; ++y) {
    for (int x = 0; x < options.width_px; ++x) {
      first = std::min(first, partner_of(x, y));
      last = std::max(last, partner_of(x, y));
    }
  }
  // As steep as in the book if that stays within 0..255.
  const double slope = std::min(kRampSlopePerPx, 255.0 / std::max(1, last - first));
  const double at_zero = 127.5 - slope * (first + last) / 2.0;
  const auto ramp = [&](int x) { return static_cast<float>(at_zero + slope * x); };

  Image<float> unbroken(options.width_px, options.height_px);
  Image<float> broken(options.width_px, options.height_px);
  for (int y = 0; y < options.height_px; ++y) {
    for (int x = 0; x < options.width_px; ++x) {
      unbroken.at(x, y) = ramp(x);
      broken.at(x, y) = ramp(partner_of(x, y));
    }
  }
  if (options.reference == Side::kLeft) {
    return {std::move(broken), std::move(unbroken)};
  }
  return {std::move(unbroken), std::move(broken)};
}

Image<float> paint(const BookPairOptions& options, const std::vector<Layer>& layers,
                   const std::vector<Texture>& textures, const Image<std::uint8_t>& visible,
                   Side grid) {
  Image<float> image(options.width_px, options.height_px);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const std::size_t layer = visible.at(x, y);
      const int shift = shift_to_reference(layers[layer], grid, options.reference);
      image.at(x, y) = static_cast<float>(textures[layer].at(x + shift, y));
    }
  }
  return image;
}

Photograph finish(const BookPairOptions& options, Image<float> grey, Stream noise_stream) {
  if (options.noise_sigma > 0) {
    PortableRandom random(options.seed, noise_stream);
    for (int y = 0; y < grey.height(); ++y) {
      for (int x = 0; x < grey.width(); ++x) {
        grey.at(x, y) += static_cast<float>(options.noise_sigma * random.normal());
      }
    }
  }
  if (options.noise_sigma > 0 || options.float_pixels) {
    for (int y = 0; y < grey.height(); ++y) {
      std::transform(grey.row(y), grey.row(y) + grey.width(), grey.row(y),
                     [](float level) { return level / kGreyLevelsPerUnit<float>; });
    }
    return {std::move(grey)};
  }
  Image<std::uint8_t> rounded(grey.width(), grey.height());
  for (int y = 0; y < grey.height(); ++y) {
    std::transform(grey.row(y), grey.row(y) + grey.width(), rounded.row(y), [](float level) {
      return static_cast<std::uint8_t>(std::clamp(std::floor(level + 0.5F), 0.0F, 255.0F));
    });
  }
  return {std::move(rounded)};
}

}  // namespace

int BookPairOptions::front_disparity_or_default() const {
  return front_disparity_px.value_or(shape == BookShape::kSquare ? 6 : 7);
}

int BookPairOptions::narrow_disparity_or_default() const {
  return narrow_disparity_px.value_or(16);
}

void BookPairOptions::validate() const {
  require_between("width", width_px, 1, kMaxGeneratedSidePx);
  require_between("height", height_px, 1, kMaxGeneratedSidePx);
  require_between("background disparity", background_disparity_px, -kMaxDisparityPx,
                  kMaxDisparityPx);
  require_between("front disparity", front_disparity_or_default(), background_disparity_px + 1,
                  kMaxDisparityPx);
  if (shape == BookShape::kBars) {
    require_between("narrow disparity", narrow_disparity_or_default(),
                    front_disparity_or_default() + 1, kMaxDisparityPx);
  }
  require_between("noise", noise_sigma, 0, 255);
  if (pattern == BookPattern::kRamp && shape == BookShape::kBars) {
    throw UsageError("pattern ramp with shape bars has no unique match, expected shape square");
  }
}

BookPairOptions book_pair_options(std::string_view name) {
  constexpr BookPairOptions kPairs[kBookPairNames.size()] = {
      {.pattern = BookPattern::kRamp, .shape = BookShape::kSquare},
      {.pattern = BookPattern::kRandomDots, .shape = BookShape::kSquare},
      {.pattern = BookPattern::kGrass, .shape = BookShape::kSquare},
      {.pattern = BookPattern::kRandomDots, .shape = BookShape::kBars},
      {.pattern = BookPattern::kGrass, .shape = BookShape::kBars}};
  const auto found = std::find(kBookPairNames.begin(), kBookPairNames.end(), name);
  if (found == kBookPairNames.end()) {
    throw UsageError(fmt::format("pair '{}' is unknown, expected one of {}", quotable(name),
                                 fmt::join(kBookPairNames, ", ")));
  }
  return kPairs[found - kBookPairNames.begin()];
}

BookPair make_book_pair(const BookPairOptions& options) {
  options.validate();
  const std::vector<Layer> layers = make_layers(options);
  const Image<std::uint8_t> in_left = visible_layers(layers, options, Side::kLeft);
  const Image<std::uint8_t> in_right = visible_layers(layers, options, Side::kRight);

  Intensities grey;
  if (options.pattern == BookPattern::kRamp) {
    grey = make_ramp(options, layers, options.reference == Side::kLeft ? in_left : in_right);
  } else {
    std::vector<Texture> textures;
    for (const Layer& layer : layers) {
      const Side other = other_side(options.reference);
      const int shift = shift_to_reference(layer, other, options.reference);
      textures.emplace_back(options, std::min(0, shift), options.width_px + std::max(0, shift),
                            kTextureStream + textures.size());
    }
    grey.left = paint(options, layers, textures, in_left, Side::kLeft);
    grey.right = paint(options, layers, textures, in_right, Side::kRight);
  }

  const int nearest = layers.front().disparity_px;
  return {.left = finish(options, std::move(grey.left), kLeftNoiseStream),
          .right = finish(options, std::move(grey.right), kRightNoiseStream),
          .left_disparity = disparities_of(layers, in_left),
          .right_disparity = disparities_of(layers, in_right),
          .left_occluded = occluded_pixels(layers, in_left, in_right, -1),
          .right_occluded = occluded_pixels(layers, in_right, in_left, +1),
          .search = {std::min(0, options.background_disparity_px), nearest + kSearchMarginPx}};
}

}  // namespace vantage
