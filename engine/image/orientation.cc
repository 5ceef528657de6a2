#include "engine/image/orientation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <variant>

#include "engine/error.h"
#include "engine/image/photograph.h"

namespace vantage {
namespace {

std::string_view name_of(Orientation orientation) {
  constexpr std::array<std::string_view, 8> kNames = {"as stored",
                                                      "mirrored",
                                                      "turned by 180 degrees",
                                                      "flipped",
                                                      "transposed",
                                                      "turned by 90 degrees clockwise",
                                                      "transposed and turned by 180 degrees",
                                                      "turned by 90 degrees counterclockwise"};
  return kNames.at(static_cast<std::size_t>(orientation) - 1);
}

/// Copies pixels of kChannels: result(x, y) = image at row y, or column y where sides are
/// exchanged, from the far end where `mirrors` (x) or `flips` (y).
template <int kChannels, typename T>
void turn_into(ImageView<const T> image, bool exchanges_sides, bool mirrors, bool flips,
               Image<T>& result) {
  const int block_rows = exchanges_sides ? 32 : 1;  // as pixels lie one after another
  const auto stride = static_cast<std::ptrdiff_t>(image.stride());
  const std::ptrdiff_t along_x = exchanges_sides ? stride : kChannels;
  const std::ptrdiff_t along_y = exchanges_sides ? kChannels : stride;
  const int width = result.width();
  const int height = result.height();
  for (int block = 0; block < height; block += block_rows) {
    for (int x = 0; x < width; ++x) {
      const T* const column = image.data() + along_x * (mirrors ? width - 1 - x : x);
      for (int y = block; y < std::min(block + block_rows, height); ++y) {
        std::copy_n(column + along_y * (flips ? height - 1 - y : y), kChannels,
                    result.row(y) + x * kChannels);
      }
    }
  }
}

}  // namespace

Orientation orientation_of_tag(long long value) {
  return value >= 1 && value <= 8 ? static_cast<Orientation>(value) : Orientation::kAsStored;
}

template <typename T>
Image<T> turned(ImageView<const T> image, Orientation orientation) {
  using enum Orientation;
  const bool exchanges_sides = orientation >= kTranspose;
  const bool mirrors = orientation == kMirror || orientation == kTurn180 ||
                       orientation == kTurn90 || orientation == kTransposeTurn180;
  const bool flips = orientation == kTurn180 || orientation == kFlip ||
                     orientation == kTransposeTurn180 || orientation == kTurn270;
  if (image.empty()) {
    return {};
  }
  if (!exchanges_sides && !mirrors && !flips) {
    return Image<T>::copy_of(image);
  }
  Image<T> result(exchanges_sides ? image.height() : image.width(),
                  exchanges_sides ? image.width() : image.height(), image.channels());
  const auto turn = [&]<int kChannels>(std::integral_constant<int, kChannels>) {
    turn_into<kChannels>(image, exchanges_sides, mirrors, flips, result);
  };
  if (image.channels() == 1) {
    turn(std::integral_constant<int, 1>());
  } else if (image.channels() == 3) {
    turn(std::integral_constant<int, 3>());
  } else {
    turn(std::integral_constant<int, 4>());
  }
  return result;
}

template Image<std::uint8_t> turned(ImageView<const std::uint8_t>, Orientation);
template Image<std::uint16_t> turned(ImageView<const std::uint16_t>, Orientation);
template Image<float> turned(ImageView<const float>, Orientation);

void turn_upright(Photograph& photograph, Orientation orientation) {
  if (orientation == Orientation::kAsStored) {
    return;
  }
  std::visit([&]<typename T>(Image<T>& image) { image = turned<T>(image.view(), orientation); },
             photograph.pixels);
  photograph.left_out = turned<std::uint8_t>(photograph.left_out.view(), orientation);
  photograph.origin.turn = orientation;
  photograph.origin.remarks.push_back(
      {Remark::Kind::kNote, "orientation",
       fmt::format("images are {}, as their files say (`orientation` stored leaves them)",
                   name_of(orientation))});
}

void require_equal_turns(const Photograph& left, const Photograph& right) {
  const Orientation of_left = left.origin.turn;
  const Orientation of_right = right.origin.turn;
  if (of_left != of_right) {
    throw Error(fmt::format(
        "the left image is {}, but the right one {}, as their files say; expected the same of both "
        "(`orientation` stored leaves them)",
        name_of(of_left), name_of(of_right)));
  }
}

}  // namespace vantage
