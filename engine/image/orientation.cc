#include "engine/image/orientation.h"

#include <fmt/format.h>

#include <array>
#include <opencv2/core.hpp>
#include <string_view>
#include <utility>

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

// OpenCV does not change its source, but cv::Mat has no view of constant pixels.
template <typename T>
cv::Mat as_matrix(ImageView<const T> image) {
  return {image.height(), image.width(), CV_MAKETYPE(cv::DataType<T>::depth, image.channels()),
          const_cast<T*>(image.data()),  // NOLINT(cppcoreguidelines-pro-type-const-cast)
          image.stride() * sizeof(T)};
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
  cv::Mat target = as_matrix<T>(result.view());
  cv::Mat source = as_matrix<T>(image);
  if (exchanges_sides) {
    cv::transpose(source, target);
    source = target;
  }
  if (mirrors || flips) {
    cv::flip(source, target, mirrors && flips ? -1 : mirrors ? 1 : 0);
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
