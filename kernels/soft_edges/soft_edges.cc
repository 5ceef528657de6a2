#include "kernels/soft_edges/soft_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "kernels/row_bits/row_bits.h"

namespace vantage::kernels {
namespace {

constexpr double kUsualShare = 0.2;
constexpr double kMaxShare = 0.5;
constexpr double kSyntheticShiftPx = 2;

/// Weight of each image in what the view shows at a position.
struct ImageShares {
  double left;
  double right;
};

ImageShares image_shares(const OutlineRow& row, int x) {
  const float d = row.disparity_px[x];
  const bool in_left = std::abs(row.left_disparity_px[x] - d) <= row.gradient_limit_px;
  const bool in_right = std::abs(row.right_disparity_px[x] - d) <= row.gradient_limit_px;
  if (in_left != in_right) {
    return {in_left ? 1.0 : 0.0, in_left ? 0.0 : 1.0};
  }
  return {row.alpha, 1.0 - row.alpha};  // also for filled holes
}

// Distance to the right of its position to which the pixel shown at x was mapped.
double mapped_beside(const OutlineRow& row, int x) {
  const auto beside = [x](double offset, float disparity_px) {
    const double column = x + offset * disparity_px;
    return std::isnan(column) ? 0.0 : std::floor(column + 0.5) - column;
  };
  const ImageShares shares = image_shares(row, x);
  // Not a single sum of products: the image with weight 0 may be undefined (NaN) here.
  const double left =
      shares.left > 0 ? shares.left * beside(row.left_offset, row.left_disparity_px[x]) : 0.0;
  const double right =
      shares.right > 0 ? shares.right * beside(row.right_offset, row.right_disparity_px[x]) : 0.0;
  return left + right;
}

// Shares at the outline between x and x + 1.
void share_pixels(const OutlineRow& row, int x, std::uint8_t* shares) {
  const float left_d = row.disparity_px[x];
  const float right_d = row.disparity_px[x + 1];
  const bool left_is_nearer = left_d > right_d;
  const int nearer = left_is_nearer ? x : x + 1;
  const int farther = left_is_nearer ? x + 1 : x;
  // Coverage of the farther position by the nearer surface; negative: the nearer position is partly
  // uncovered.
  const double covered = mapped_beside(row, nearer) * (left_is_nearer ? 1 : -1);
  const ImageShares from = image_shares(row, farther);
  const double shift_px =
      (from.left * std::abs(row.left_offset) + from.right * std::abs(row.right_offset)) *
      std::abs(double{left_d} - right_d);
  const double strength = std::min(1.0, shift_px / kSyntheticShiftPx);
  const auto share = [strength](double part) {
    const double slope = part > 0 ? kMaxShare - kUsualShare : kUsualShare;  // per half pixel
    return static_cast<std::uint8_t>(strength * (kUsualShare + 2 * slope * part) * kWholeShare +
                                     0.5);
  };
  const std::uint8_t of_nearer = share(covered);
  const std::uint8_t of_farther = share(-covered);
  shares[2 * x + 1] = left_is_nearer ? of_farther : of_nearer;
  shares[2 * (x + 1)] = left_is_nearer ? of_nearer : of_farther;
}

template <typename T>
T mixed(T own, T left, T right, int of_left, int of_right) {
  if constexpr (std::is_same_v<T, float>) {
    constexpr float kUnit = 1.0F / kWholeShare;
    return own + (kUnit * static_cast<float>(of_left) * (left - own) +
                  kUnit * static_cast<float>(of_right) * (right - own));
  } else {
    const int sum = (kWholeShare - of_left - of_right) * own + of_left * left + of_right * right;
    return static_cast<T>((sum + kWholeShare / 2) / kWholeShare);
  }
}

template <typename T>
void mix(const std::uint8_t* shares, int width, int channels, T* pixels) {
  constexpr int kPixelsAtOnce = 4;
  constexpr int kBitsPerPixel = 16;
  T original[4] = {};  // value of `original_x` before it was changed
  int original_x = -1;
  const auto mix_pixel = [&](int x) {
    const int of_left = shares[2 * x];
    const int of_right = shares[2 * x + 1];
    T* pixel = pixels + x * channels;
    const T* left = of_left == 0 ? pixel : original_x == x - 1 ? original : pixel - channels;
    const T* right = of_right == 0 ? pixel : pixel + channels;
    for (int c = 0; c < channels; ++c) {
      const T own = pixel[c];
      const T left_value = left[c];
      original[c] = own;
      pixel[c] = mixed(own, left_value, right[c], of_left, of_right);
    }
    original_x = x;
  };
  int begin = 0;
  for (; begin + kPixelsAtOnce <= width; begin += kPixelsAtOnce) {
    std::uint64_t rest = 0;  // little-endian: the first pixel has the lowest bits
    std::memcpy(&rest, shares + 2 * begin, sizeof(rest));
    while (rest != 0) {
      const int i = std::countr_zero(rest) / kBitsPerPixel;
      mix_pixel(begin + i);
      rest &= ~std::uint64_t{0} << (kBitsPerPixel * i) << kBitsPerPixel;
    }
  }
  for (; begin < width; ++begin) {
    mix_pixel(begin);
  }
}

}  // namespace

int outline_shares_row(const OutlineRow& row, std::uint8_t* shares) {
  constexpr int kBlock = 1024;
  std::uint64_t alike[row_words(kBlock)];
  std::fill_n(shares, 2 * row.width, std::uint8_t{0});
  int outlines = 0;
  for (int begin = 0; begin < row.width - 1; begin += kBlock) {
    const int count = std::min(kBlock, row.width - 1 - begin);
    const float* disparity_px = row.disparity_px + begin;
    near_bits_row(disparity_px, disparity_px + 1, row.gradient_limit_px, count, alike);
    for (int word = 0; word < row_words(count); ++word) {
      const int bits = std::min(64, count - 64 * word);
      const std::uint64_t wanted = bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
      for (std::uint64_t unlike = ~alike[word] & wanted; unlike != 0; unlike &= unlike - 1) {
        const int x = begin + 64 * word + std::countr_zero(unlike);
        // An unfilled hole has no colour to mix.
        if (!std::isnan(row.disparity_px[x]) && !std::isnan(row.disparity_px[x + 1])) {
          share_pixels(row, x, shares);
          ++outlines;
        }
      }
    }
  }
  return outlines;
}

void mix_outlines_row(const std::uint8_t* shares, int width, int channels, std::uint8_t* pixels) {
  mix(shares, width, channels, pixels);
}
void mix_outlines_row(const std::uint8_t* shares, int width, int channels, std::uint16_t* pixels) {
  mix(shares, width, channels, pixels);
}
void mix_outlines_row(const std::uint8_t* shares, int width, int channels, float* pixels) {
  mix(shares, width, channels, pixels);
}

}  // namespace vantage::kernels
