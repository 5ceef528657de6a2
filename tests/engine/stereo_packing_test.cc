#include "engine/image/stereo_packing.h"

#include "tests/engine/engine_test.h"

namespace vantage::stereo_packing_test {

struct Size {
  int width;
  int height;
};
constexpr Size kSizes[] = {{1, 1}, {2, 1}, {1, 2}, {13, 7}, {31, 1}, {1, 31}, {64, 5}, {129, 33}};

StereoPacking packing_of(std::string_view name) {
  const auto& names = stereo_packing_names();
  const auto found =
      std::ranges::find(names, name, &std::pair<std::string_view, StereoPacking>::first);
  EXPECT_NE(found, names.end()) << name;
  return found->second;
}

bool divides_height(StereoPacking packing) {
  return packing.layout == StereoLayout::kAboveBelow || packing.layout == StereoLayout::kRows;
}

/// Those of one picture: the test of displays has the places of interleaved ones.
std::vector<std::pair<std::string_view, StereoPacking>> names_of_halves() {
  auto names = stereo_packing_names();
  std::erase_if(names, [](const auto& name) {
    return name.second.layout != StereoLayout::kSideBySide &&
           name.second.layout != StereoLayout::kAboveBelow;
  });
  return names;
}

/// Value of any photograph as double.
double value(const Photograph& photograph, int x, int y, int channel = 0) {
  return std::visit([&](const auto& image) { return static_cast<double>(image.at(x, y, channel)); },
                    photograph.pixels);
}

template <typename T>
class StereoPackingTest : public testing::Test {};
using Depths = testing::Types<std::uint8_t, std::uint16_t, float>;
TYPED_TEST_SUITE(StereoPackingTest, Depths);

TYPED_TEST(StereoPackingTest, FullSizesComeBack) {
  for (const auto& [name, packing] : stereo_packing_names()) {
    if (packing.layout == StereoLayout::kFrames) {
      continue;
    }
    for (const Size size : kSizes) {
      for (const int channels : {1, 3, 4}) {
        const Photograph left = noise<TypeParam>(size.width, size.height, channels, 1);
        const Photograph right = noise<TypeParam>(size.width, size.height, channels, 2);
        Photograph packed;
        pack_stereo(left, right, packing, packed);
        Photograph left_again;
        Photograph right_again;
        unpack_stereo(packed, packing, left_again, right_again);
        Photograph left_alone;
        unpack_left(packed, packing, left_alone);
        EXPECT_TRUE(same(left_alone, left_again)) << name;
        if (!packing.half_size) {
          EXPECT_TRUE(same(left, left_again)) << name << " " << size.width << "x" << size.height;
          EXPECT_TRUE(same(right, right_again)) << name << " " << size.width << "x" << size.height;
        } else {
          // One column or row more where the size is odd.
          EXPECT_EQ(left_again.width(),
                    divides_height(packing) ? size.width : (size.width + 1) / 2 * 2);
          EXPECT_EQ(left_again.height(),
                    divides_height(packing) ? (size.height + 1) / 2 * 2 : size.height);
          EXPECT_EQ(right_again.width(), left_again.width());
          EXPECT_EQ(right_again.channels(), channels);
        }
      }
    }
  }
}

/// Every packed pixel from its place in one of the images, by the names' meaning.
TYPED_TEST(StereoPackingTest, EveryNameMeansItsPlaces) {
  constexpr double kRounding = std::is_same_v<TypeParam, float> ? 1e-6 : 0.5;
  for (const Size size : kSizes) {
    const Photograph left = noise<TypeParam>(size.width, size.height, 3, 3);
    const Photograph right = noise<TypeParam>(size.width, size.height, 3, 4);
    for (const auto& [name, packing] : names_of_halves()) {
      const bool half = name.find('2') != std::string_view::npos;
      const bool is_column_pair = name.starts_with("sbs");
      const Photograph& first = name.ends_with('l') ? left : right;
      const Photograph& second = name.ends_with('l') ? right : left;
      Photograph packed;
      pack_stereo(left, right, packing, packed);
      const int part_width = half && is_column_pair ? (size.width + 1) / 2 : size.width;
      const int part_height = half && !is_column_pair ? (size.height + 1) / 2 : size.height;
      ASSERT_EQ(packed.width(), is_column_pair ? 2 * part_width : part_width) << name;
      ASSERT_EQ(packed.height(), is_column_pair ? part_height : 2 * part_height) << name;
      for (const auto [x, y] : positions_of(packed)) {
        const bool in_second = is_column_pair ? x >= part_width : y >= part_height;
        const Photograph& source = in_second ? second : first;
        const int px = is_column_pair ? x % part_width : x;
        const int py = is_column_pair ? y : y % part_height;
        for (int c = 0; c < 3; ++c) {
          double expected = value(source, px, py, c);
          if (half) {
            const int xa = is_column_pair ? 2 * px : px;
            const int ya = is_column_pair ? py : 2 * py;
            const int xb = is_column_pair ? std::min(xa + 1, size.width - 1) : xa;
            const int yb = is_column_pair ? ya : std::min(ya + 1, size.height - 1);
            expected = (value(source, xa, ya, c) + value(source, xb, yb, c)) / 2;
          }
          const double error = value(packed, x, y, c) - expected;
          ASSERT_LE(std::abs(error), kRounding) << name << " " << x << " " << y;
        }
      }
    }
  }
}

/// Cubic interpolation (a = −½) at the places where the pixels of the full size lie, border values
/// repeated.
double cubic(const Photograph& packed, int first, int count, double at, bool columns, int other,
             int channel) {
  const auto weight = [](double distance) {
    constexpr double kA = -0.5;
    const double d = std::abs(distance);
    if (d <= 1) {
      return (kA + 2) * d * d * d - (kA + 3) * d * d + 1;
    }
    return d < 2 ? kA * (d * d * d - 5 * d * d + 8 * d - 4) : 0.0;
  };
  double sum = 0;
  for (int i = static_cast<int>(std::floor(at)) - 1; i <= std::floor(at) + 2; ++i) {
    const int sample = first + std::clamp(i, 0, count - 1);
    sum += weight(at - i) * (columns ? value(packed, sample, other, channel)
                                     : value(packed, other, sample, channel));
  }
  return sum;
}

/// What values are held to: the range of the type, for floats of the half image.
template <typename T>
std::pair<double, double> limits_of(const Photograph& packed, StereoPacking packing, int first) {
  if constexpr (!std::is_same_v<T, float>) {
    return {0, std::numeric_limits<T>::max()};
  }
  std::pair<double, double> limits{1, 0};
  const int width = divides_height(packing) ? packed.width() : packed.width() / 2;
  const int height = divides_height(packing) ? packed.height() / 2 : packed.height();
  for (const auto [x, y] : positions_of(width, height)) {
    for (int c = 0; c < packed.channels(); ++c) {
      const double here =
          divides_height(packing) ? value(packed, x, first + y, c) : value(packed, first + x, y, c);
      limits = {std::min(limits.first, here), std::max(limits.second, here)};
    }
  }
  return limits;
}

TYPED_TEST(StereoPackingTest, HalfSizesAreStretchedByCubicInterpolation) {
  constexpr double kRounding = std::is_same_v<TypeParam, float> ? 1e-6 : 0.5;
  for (const char* name : {"sbs2l", "sbs2r", "ab2l", "tb2r"}) {
    const StereoPacking packing = packing_of(name);
    const bool columns = !divides_height(packing);
    for (const Size size : {Size{2, 2}, Size{4, 6}, Size{6, 4}, Size{62, 6}, Size{34, 38}}) {
      const Photograph packed = noise<TypeParam>(size.width, size.height, 3, 5);
      Photograph left;
      Photograph right;
      unpack_stereo(packed, packing, left, right);
      const int count = (columns ? size.width : size.height) / 2;
      for (const bool is_right : {false, true}) {
        const Photograph& image = is_right ? right : left;
        ASSERT_EQ(image.width(), size.width);
        ASSERT_EQ(image.height(), size.height);
        const int first = is_right == packing.right_first ? 0 : count;
        const auto [smallest, largest] = limits_of<TypeParam>(packed, packing, first);
        for (const auto [x, y] : positions_of(size.width, size.height)) {
          const double at = ((columns ? x : y) + 0.5) / 2 - 0.5;
          for (int c = 0; c < 3; ++c) {
            const double expected = cubic(packed, first, count, at, columns, columns ? y : x, c);
            ASSERT_NEAR(value(image, x, y, c), std::clamp(expected, smallest, largest), kRounding)
                << name << " " << x << " " << y;
          }
        }
      }
    }
  }
}

TEST(StereoPacking, NamesAndSynonyms) {
  EXPECT_EQ(stereo_packing_names().size(), 18U);
  for (const char* ending : {"l", "r", "2l", "2r"}) {
    EXPECT_EQ(packing_of(std::string("tb") + ending), packing_of(std::string("ab") + ending));
    EXPECT_NE(packing_of(std::string("sbs") + ending), packing_of(std::string("ab") + ending));
  }
  for (const char* name : {"sbsl", "ab2r", "irr", "icl", "ar"}) {
    EXPECT_EQ(to_name(packing_of(name)), name);
  }
}

TEST(StereoPacking, MemoryIsReusedWhateverTheDepthWas) {
  Photograph left = noise<float>(5, 4, 1);
  Photograph right;
  unpack_stereo(noise<std::uint8_t>(6, 4, 3), {}, left, right);
  const auto* memory = std::get<Image<std::uint8_t>>(left.pixels).row(0);
  unpack_stereo(noise<std::uint8_t>(6, 4, 3, 9), {}, left, right);
  EXPECT_EQ(std::get<Image<std::uint8_t>>(left.pixels).row(0), memory);
}

TEST(StereoPacking, RefusesWhatDoesNotFit) {
  Photograph left;
  Photograph right;
  const auto unpack_error = [&](int width, int height, const char* name) {
    return error_of([&] {
      unpack_stereo(noise<std::uint8_t>(width, height, 1), packing_of(name), left, right);
    });
  };
  EXPECT_THAT(unpack_error(5, 4, "sbsl"), HasSubstr("packed image is 5x4, expected an even width"));
  EXPECT_THAT(unpack_error(4, 5, "ab2r"),
              HasSubstr("packed image is 4x5, expected an even height"));
  EXPECT_THAT(unpack_error(5, 4, "icr"), HasSubstr("expected an even width"));
  EXPECT_THAT(unpack_error(4, 5, "irl"), HasSubstr("expected an even height"));
  EXPECT_EQ(unpack_error(4, 5, "sbs2r"), "");
  EXPECT_EQ(unpack_error(5, 4, "abl"), "");
  EXPECT_NE(error_of([&] { unpack_stereo(Photograph(), {}, left, right); }), "");
  const auto pack_error = [&](const Photograph& other) {
    Photograph packed;
    return error_of([&] { pack_stereo(noise<std::uint8_t>(5, 4, 3), other, {}, packed); });
  };
  EXPECT_EQ(pack_error(noise<std::uint8_t>(5, 4, 3)), "");
  EXPECT_EQ(pack_error(noise<std::uint8_t>(4, 4, 3)),
            "left image is 5x4 with 3 8-bit channels but right image is 4x4 with 3 8-bit channels, "
            "expected equal shapes");
  EXPECT_NE(pack_error(noise<std::uint8_t>(5, 3, 3)), "");
  EXPECT_NE(pack_error(noise<std::uint8_t>(5, 4, 1)), "");
  EXPECT_NE(pack_error(noise<std::uint16_t>(5, 4, 3)), "");
}

}  // namespace vantage::stereo_packing_test
