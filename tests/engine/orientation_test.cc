#include "engine/image/orientation.h"

#include <gtest/gtest.h>

#include "engine/image/photograph.h"

namespace vantage {
namespace {

/// Where pixel (x, y) of a stored picture of w × h pixels belongs, as the EXIF standard draws it:
/// the visual place of its row 0 and of its column 0.
std::pair<int, int> upright_place(int tag, int x, int y, int w, int h) {
  switch (tag) {
    case 2:  // row 0 is the top, column 0 the right side
      return {w - 1 - x, y};
    case 3:  // bottom, right
      return {w - 1 - x, h - 1 - y};
    case 4:  // bottom, left
      return {x, h - 1 - y};
    case 5:  // row 0 is the left side, column 0 the top
      return {y, x};
    case 6:  // right, top
      return {h - 1 - y, x};
    case 7:  // right, bottom
      return {h - 1 - y, w - 1 - x};
    case 8:  // left, bottom
      return {y, w - 1 - x};
    default:
      return {x, y};
  }
}

template <typename T>
void expect_turned(int tag, int channels) {
  Image<T> stored(5, 3, channels);
  for (int y = 0; y < 3; ++y) {
    for (int i = 0; i < 5 * channels; ++i) {
      stored.row(y)[i] = static_cast<T>(1 + y * 5 * channels + i);
    }
  }
  const Image<T> upright = turned<T>(stored.view(), orientation_of_tag(tag));
  ASSERT_EQ(upright.width(), tag > 4 && tag < 9 ? 3 : 5) << tag;
  ASSERT_EQ(upright.height(), tag > 4 && tag < 9 ? 5 : 3) << tag;
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x) {
      const auto [u, v] = upright_place(tag, x, y, 5, 3);
      for (int c = 0; c < channels; ++c) {
        EXPECT_EQ(upright.at(u, v, c), stored.at(x, y, c)) << tag << ": " << x << ", " << y;
      }
    }
  }
}

TEST(Orientation, PutsEachPixelWhereTheTagSays) {
  for (int tag = 0; tag <= 9; ++tag) {
    expect_turned<std::uint8_t>(tag, 1);
    expect_turned<std::uint8_t>(tag, 3);
    expect_turned<std::uint16_t>(tag, 3);
    expect_turned<float>(tag, 4);
  }
}

}  // namespace
}  // namespace vantage
