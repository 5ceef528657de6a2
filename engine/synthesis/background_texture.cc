#include "engine/synthesis/background_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>
#include <type_traits>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/synthesis/hole_patches.h"

namespace vantage {
namespace {

// Comparisons of pixels that all holes of an image may take, about half a second of one core.
constexpr double kBudget = 4e8;
constexpr double kPixelsPerPatch = 40;  // of a hole, filled by one patch
constexpr double kPatchesPerSearch = 97 * 97;
// Priority of patches without edges.
constexpr float kFlatPriority = 0.01F;

constexpr std::array<PixelPosition, 4> kNeighbours = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

template <typename T>
std::uint8_t level_of(T value) {
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    return value;
  } else {
    const float level = static_cast<float>(value) * kGreyLevelsPerUnit<T>;
    return static_cast<std::uint8_t>(std::clamp(level, 0.0F, 255.0F) + 0.5F);
  }
}

/// Labels 8-connected holes from 1 on. Returns the pixels of each.
std::vector<std::vector<PixelPosition>> label_holes(ImageView<const std::uint8_t> wanted,
                                                    Image<std::int32_t>& labels) {
  const int width = wanted.width();
  const int height = wanted.height();
  std::vector<std::vector<PixelPosition>> holes;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (wanted.at(x, y) == 0 || labels.at(x, y) != 0) {
        continue;
      }
      auto& pixels = holes.emplace_back(1, PixelPosition{x, y});
      const auto label = static_cast<std::int32_t>(holes.size());
      labels.at(x, y) = label;
      for (std::size_t next = 0; next < pixels.size(); ++next) {
        const PixelPosition at = pixels[next];
        for (int row = std::max(at.y - 1, 0); row <= std::min(at.y + 1, height - 1); ++row) {
          for (int column = std::max(at.x - 1, 0); column <= std::min(at.x + 1, width - 1);
               ++column) {
            if (wanted.at(column, row) != 0 && labels.at(column, row) == 0) {
              labels.at(column, row) = label;
              pixels.push_back({column, row});
            }
          }
        }
      }
    }
  }
  return holes;
}

/// Fills one hole. Writes its own pixels only.
template <typename T>
class HoleSynthesis {
 public:
  HoleSynthesis(const std::vector<PixelPosition>& pixels, HoleImage& holes, ImageView<T> image)
      : holes_(holes), image_(image), own_(holes.labels.at(pixels.front().x, pixels.front().y)) {
    for (const PixelPosition& pixel : pixels) {
      add_to_front(pixel);
    }
  }

  void fill() {
    while (!front_.empty()) {
      const auto [priority, y, x] = front_.top();
      front_.pop();
      const PixelPosition centre{-x, -y};
      if (is_filled(centre) || priority != this->priority(centre)) {
        continue;  // it has another place in the queue
      }
      const TargetPatch target(holes_, centre);
      const auto source = find_source(holes_, target, centre);
      copy_patch(centre, source.value_or(centre), std::max(target.confidence(), 1e-6F));
      add_front_around(centre);
    }
  }

 private:
  [[nodiscard]] bool is_inside(PixelPosition at) const {
    return at.x >= 0 && at.x < image_.width() && at.y >= 0 && at.y < image_.height();
  }
  [[nodiscard]] bool is_own(PixelPosition at) const { return holes_.labels.at(at.x, at.y) == own_; }
  [[nodiscard]] bool is_filled(PixelPosition at) const {
    return holes_.confidence.at(at.x, at.y) > 0;
  }
  [[nodiscard]] float disparity(PixelPosition at) const {
    return holes_.disparity_px.at(at.x, at.y);
  }
  /// Whether `beside` is known and on the background of `at`.
  [[nodiscard]] bool continues(PixelPosition at, PixelPosition beside) const {
    return is_inside(beside) && (holes_.labels.at(beside.x, beside.y) == 0 || is_own(beside)) &&
           is_filled(beside) && !(disparity(beside) > disparity(at) + holes_.limit_px);
  }

  /// How strongly edges run into the hole at a pixel of its front: their gradient along the front.
  [[nodiscard]] float edge_strength(PixelPosition at) const {
    float normal_x = 0;
    float normal_y = 0;
    for (const PixelPosition& step : kNeighbours) {
      if (continues(at, {at.x + step.x, at.y + step.y})) {
        normal_x += static_cast<float>(step.x);
        normal_y += static_cast<float>(step.y);
      }
    }
    float strongest = 0;
    for (int y = at.y - 1; y <= at.y + 1; ++y) {
      for (int x = at.x - 1; x <= at.x + 1; ++x) {
        const std::array<PixelPosition, 4> around = {
            {{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}}};
        if (std::ranges::all_of(around, [&](PixelPosition p) { return continues(at, p); })) {
          const float gradient_x = (grey(around[1]) - grey(around[0])) / 2;
          const float gradient_y = (grey(around[3]) - grey(around[2])) / 2;
          strongest = std::max(strongest, std::abs(gradient_x * normal_y - gradient_y * normal_x));
        }
      }
    }
    return strongest / 255;
  }
  [[nodiscard]] float grey(PixelPosition at) const {
    const std::uint8_t* level = holes_.levels.row(at.y) + std::ptrdiff_t{4} * at.x;
    return static_cast<float>(level[0] + level[1] + level[2]) / 3;
  }

  [[nodiscard]] float priority(PixelPosition at) const {
    return TargetPatch(holes_, at).confidence() * (edge_strength(at) + kFlatPriority);
  }

  void add_to_front(PixelPosition at) {
    const bool is_front = std::ranges::any_of(kNeighbours, [&](PixelPosition step) {
      return continues(at, {at.x + step.x, at.y + step.y});
    });
    if (is_front) {
      front_.emplace(priority(at), -at.y, -at.x);
    }
  }

  /// Priorities change as far as patches reach.
  void add_front_around(PixelPosition centre) {
    constexpr int kReach = 2 * kPatchRadiusPx + 1;
    for (int y = centre.y - kReach; y <= centre.y + kReach; ++y) {
      for (int x = centre.x - kReach; x <= centre.x + kReach; ++x) {
        if (is_inside({x, y}) && is_own({x, y}) && !is_filled({x, y})) {
          add_to_front({x, y});
        }
      }
    }
  }

  /// Pixels of the hole around `centre` on the same background take the values around `source`.
  void copy_patch(PixelPosition centre, PixelPosition source, float confidence) {
    for (int row = -kPatchRadiusPx; row <= kPatchRadiusPx; ++row) {
      for (int column = -kPatchRadiusPx; column <= kPatchRadiusPx; ++column) {
        const PixelPosition to{centre.x + column, centre.y + row};
        const PixelPosition from{source.x + column, source.y + row};
        if (!is_inside(to) || !is_own(to) || is_filled(to) ||
            std::abs(disparity(to) - disparity(centre)) > holes_.limit_px) {
          continue;
        }
        if (source.x != centre.x || source.y != centre.y) {
          std::copy_n(image_.row(from.y) + std::ptrdiff_t{from.x} * image_.channels(),
                      image_.channels(),
                      image_.row(to.y) + std::ptrdiff_t{to.x} * image_.channels());
          std::copy_n(holes_.levels.row(from.y) + std::ptrdiff_t{4} * from.x, 4,
                      holes_.levels.row(to.y) + std::ptrdiff_t{4} * to.x);
        }
        holes_.confidence.at(to.x, to.y) = confidence;
      }
    }
  }

  HoleImage& holes_;
  ImageView<T> image_;
  std::int32_t own_;
  std::priority_queue<std::tuple<float, int, int>> front_;  // priority, −y, −x
};

template <typename T>
void prepare(ImageView<T> image, ImageView<const std::uint8_t> wanted, HoleImage& holes) {
  const int width = image.width();
  const int height = image.height();
  holes.levels.resize(width, height, 4);
  holes.labels.resize(width, height);
  holes.labels.fill(0);
  holes.confidence.resize(width, height);
  holes.blocked.resize(width + 1, height + 1);
  holes.blocked.fill(0);
  const int second = image.channels() >= 3 ? 1 : 0;
  for (int y = 0; y < height; ++y) {
    std::int32_t in_row = 0;
    for (int x = 0; x < width; ++x) {
      std::uint8_t* level = holes.levels.row(y) + std::ptrdiff_t{4} * x;
      for (int c = 0; c < 3; ++c) {
        level[c] = level_of(image.at(x, y, c * second));
      }
      level[3] = 0;
      const bool is_hole = wanted.at(x, y) != 0;
      holes.confidence.at(x, y) = is_hole ? 0.0F : 1.0F;
      in_row += is_hole ? 1 : 0;
      holes.blocked.at(x + 1, y + 1) = holes.blocked.at(x + 1, y) + in_row;
    }
  }
}

}  // namespace

std::size_t texture_synthesis_bytes(int width, int height) {
  const auto pixels = static_cast<std::size_t>(width + 1) * static_cast<std::size_t>(height + 1);
  // Of HoleImage, and lists of the pixels of holes.
  return pixels *
         (4 + sizeof(std::int32_t) + sizeof(float) + sizeof(std::int32_t) + sizeof(PixelPosition));
}

template <typename T>
void synthesize_background_texture(ImageView<T> image, ImageView<const std::uint8_t> wanted,
                                   ImageView<const float> disparity_px, double gradient_limit_px,
                                   Execution& execution) {
  HoleImage holes;
  prepare(image, wanted, holes);
  holes.disparity_px = disparity_px;
  holes.limit_px = static_cast<float>(gradient_limit_px);
  const auto of_holes = label_holes(wanted, holes.labels);
  const double patches = holes.blocked.at(image.width(), image.height()) / kPixelsPerPatch;
  const double comparisons = patches * kPatchesPerSearch * kPatchPx * kPatchPx;
  holes.step_px = std::max(1, static_cast<int>(std::ceil(std::sqrt(comparisons / kBudget))));
  execution.executor().parallel_for(static_cast<int>(of_holes.size()), [&](int number) {
    HoleSynthesis<T>(of_holes[static_cast<std::size_t>(number)], holes, image).fill();
  });
}

template void synthesize_background_texture<std::uint8_t>(ImageView<std::uint8_t>,
                                                          ImageView<const std::uint8_t>,
                                                          ImageView<const float>, double,
                                                          Execution&);
template void synthesize_background_texture<std::uint16_t>(ImageView<std::uint16_t>,
                                                           ImageView<const std::uint8_t>,
                                                           ImageView<const float>, double,
                                                           Execution&);
template void synthesize_background_texture<float>(ImageView<float>, ImageView<const std::uint8_t>,
                                                   ImageView<const float>, double, Execution&);

}  // namespace vantage
