#include "engine/synthesis/soft_outlines.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "kernels/row_bits/row_bits.h"

namespace vantage {
namespace {

// Columns of a row that are processed together.
constexpr int kBlock = 1024;
constexpr std::size_t kMaxChannels = 4;

using Colour = std::array<double, kMaxChannels>;

std::size_t row_bytes(int width, int channels, std::size_t value_bytes) {
  constexpr std::size_t kLine = 64;
  const std::size_t pixels = static_cast<std::size_t>(width);
  const std::size_t bytes = sizeof(std::int32_t) * (1 + pixels) +
                            value_bytes * pixels * static_cast<std::size_t>(channels);
  return (bytes + kLine - 1) / kLine * kLine;
}

/// The changed pixels of a row. They are written to the image when no row needs the old ones.
template <typename T>
struct ChangedRow {
  std::int32_t* count;
  std::int32_t* column;
  T* values;

  ChangedRow(std::byte* memory, int width)
      : count(reinterpret_cast<std::int32_t*>(memory)),
        column(count + 1),
        values(reinterpret_cast<T*>(column + width)) {}
};

template <typename T>
class OutlineSoftener {
 public:
  OutlineSoftener(const EdgeCoverage& coverage, ImageView<const float> nearness,
                  float gradient_limit_px, ImageView<T> image, Execution& execution)
      : coverage_(coverage),
        nearness_(nearness),
        gradient_limit_px_(gradient_limit_px),
        image_(image),
        execution_(execution),
        row_bytes_(row_bytes(image.width(), image.channels(), sizeof(T))),
        memory_(execution.scratch().lease(
            outline_bytes(image.width(), image.height(), image.channels(), sizeof(T)))) {}

  void run() {
    execution_.for_each_row(image_.height(), [&](int y) { find_changes(y); });
    execution_.for_each_row(image_.height(), [&](int y) { apply_changes(y); });
  }

 private:
  /// A neighbouring pixel that shows another surface.
  struct Neighbour {
    int x;
    int y;
    float nearness;
  };
  struct Neighbours {
    std::array<Neighbour, 4> at;
    std::size_t count = 0;
  };

  [[nodiscard]] ChangedRow<T> changed_row(int y) const {
    return ChangedRow<T>(memory_.data() + row_bytes_ * static_cast<std::size_t>(y), image_.width());
  }

  void find_changes(int y) {
    constexpr std::uint64_t kAll = ~std::uint64_t{0};
    const int width = image_.width();
    const float* row = nearness_.row(y);
    const float* above = nearness_.row(std::max(y - 1, 0));
    const float* below = nearness_.row(std::min(y + 1, image_.height() - 1));
    ChangedRow<T> changed = changed_row(y);
    *changed.count = 0;
    std::uint64_t like_right[kernels::row_words(kBlock)];
    std::uint64_t like_above[kernels::row_words(kBlock)];
    std::uint64_t like_below[kernels::row_words(kBlock)];
    bool unlike_before = false;  // between the last column of the previous words and the first of
                                 // the next
    for (int begin = 0; begin < width; begin += kBlock) {
      const int count = std::min(kBlock, width - begin);
      const int pairs = std::min(count, width - 1 - begin);
      like_right[kernels::row_words(count) - 1] = 0;
      kernels::near_bits_row(row + begin, row + begin + 1, gradient_limit_px_, pairs, like_right);
      kernels::near_bits_row(row + begin, above + begin, gradient_limit_px_, count, like_above);
      kernels::near_bits_row(row + begin, below + begin, gradient_limit_px_, count, like_below);
      for (int word = 0; word < kernels::row_words(count); ++word) {
        const auto first_bits = [](int bits) {
          return bits >= 64 ? kAll : (std::uint64_t{1} << std::max(bits, 0)) - 1;
        };
        const std::uint64_t unlike_right = ~like_right[word] & first_bits(pairs - 64 * word);
        const std::uint64_t unlike_left = unlike_right << 1 | (unlike_before ? 1 : 0);
        unlike_before = unlike_right >> 63 != 0;
        std::uint64_t outlines =
            (unlike_right | unlike_left | ~like_above[word] | ~like_below[word]) &
            first_bits(count - 64 * word);
        for (; outlines != 0; outlines &= outlines - 1) {
          change(begin + 64 * word + std::countr_zero(outlines), y, changed);
        }
      }
    }
  }

  void apply_changes(int y) {
    const ChangedRow<T> changed = changed_row(y);
    const int channels = image_.channels();
    for (int k = 0; k < *changed.count; ++k) {
      std::copy_n(changed.values + k * channels, channels,
                  image_.row(y) + changed.column[k] * channels);
    }
  }

  void change(int x, int y, ChangedRow<T>& changed) const {
    const float own = nearness_.row(y)[x];
    if (std::isnan(own)) {
      return;
    }
    Neighbours nearer;
    Neighbours farther;
    const auto look_at = [&](int column, int line) {
      const float there = nearness_.row(line)[column];
      if (std::abs(there - own) > gradient_limit_px_) {  // false for holes without colour
        Neighbours& side = there > own ? nearer : farther;
        side.at[side.count++] = {column, line, there};
      }
    };
    if (x > 0) {
      look_at(x - 1, y);
    }
    if (x + 1 < image_.width()) {
      look_at(x + 1, y);
    }
    if (y > 0) {
      look_at(x, y - 1);
    }
    if (y + 1 < image_.height()) {
      look_at(x, y + 1);
    }
    if (nearer.count + farther.count == 0) {
      return;
    }
    Colour colour = colour_at(x, y);
    mix_farther(farther, {x, y, own}, colour);
    mix_nearer(nearer, {x, y, own}, colour);
    const int channels = image_.channels();
    T* values = changed.values + *changed.count * channels;
    for (int c = 0; c < channels; ++c) {
      const double value = colour[static_cast<std::size_t>(c)];
      values[c] = static_cast<T>(std::is_integral_v<T> ? value + 0.5 : value);
    }
    changed.column[(*changed.count)++] = x;
  }

  // Fills the uncovered fraction of the pixel with its farther neighbours.
  void mix_farther(const Neighbours& farther, const Neighbour& own, Colour& colour) const {
    if (farther.count == 0) {
      return;
    }
    float farthest = std::numeric_limits<float>::infinity();
    Colour beside{};
    for (std::size_t k = 0; k < farther.count; ++k) {
      farthest = std::min(farthest, farther.at[k].nearness);
      add(farther.at[k], 1.0 / static_cast<double>(farther.count), beside);
    }
    const double covered = coverage_({.surface_x = own.x,
                                      .surface_y = own.y,
                                      .x = own.x,
                                      .y = own.y,
                                      .nearness = own.nearness,
                                      .background_nearness = farthest});
    if (!std::isnan(covered)) {
      move_towards(beside, 1 - covered, colour);
    }
  }

  // Fills the fraction covered by nearer surfaces with them.
  void mix_nearer(const Neighbours& nearer, const Neighbour& own, Colour& colour) const {
    double max_covered = 0;
    double sum = 0;
    Colour beside{};
    for (std::size_t k = 0; k < nearer.count; ++k) {
      const Neighbour& surface = nearer.at[k];
      const double covered = coverage_({.surface_x = surface.x,
                                        .surface_y = surface.y,
                                        .x = own.x,
                                        .y = own.y,
                                        .nearness = surface.nearness,
                                        .background_nearness = own.nearness});
      if (covered > 0) {
        add(surface, covered, beside);
        sum += covered;
        max_covered = std::max(max_covered, covered);
      }
    }
    if (sum > 0) {
      for (double& value : beside) {
        value /= sum;
      }
      move_towards(beside, max_covered, colour);
    }
  }

  [[nodiscard]] Colour colour_at(int x, int y) const {
    Colour colour{};
    add({x, y, 0}, 1, colour);
    return colour;
  }

  void add(const Neighbour& pixel, double weight, Colour& sum) const {
    const int channels = image_.channels();
    const T* values = image_.row(pixel.y) + pixel.x * channels;
    for (int c = 0; c < channels; ++c) {
      sum[static_cast<std::size_t>(c)] += weight * static_cast<double>(values[c]);
    }
  }

  static void move_towards(const Colour& other, double share, Colour& colour) {
    for (std::size_t c = 0; c < kMaxChannels; ++c) {
      colour[c] += share * (other[c] - colour[c]);
    }
  }

  const EdgeCoverage& coverage_;
  ImageView<const float> nearness_;
  float gradient_limit_px_;
  ImageView<T> image_;
  Execution& execution_;
  std::size_t row_bytes_;
  scheduler::ScratchPool::Lease memory_;
};

}  // namespace

template <typename T>
void soften_outlines(const EdgeCoverage& coverage, ImageView<const float> nearness,
                     float gradient_limit_px, ImageView<T> image, Execution& execution) {
  OutlineSoftener<T>(coverage, nearness, gradient_limit_px, image, execution).run();
}

std::size_t outline_bytes(int width, int height, int channels, std::size_t value_bytes) {
  return row_bytes(width, channels, value_bytes) * static_cast<std::size_t>(height);
}

template void soften_outlines(const EdgeCoverage&, ImageView<const float>, float,
                              ImageView<std::uint8_t>, Execution&);
template void soften_outlines(const EdgeCoverage&, ImageView<const float>, float,
                              ImageView<std::uint16_t>, Execution&);
template void soften_outlines(const EdgeCoverage&, ImageView<const float>, float, ImageView<float>,
                              Execution&);

}  // namespace vantage
