#include "engine/io/maps/map_io.h"

#include "engine/io/images/photograph_io.h"
#include "tests/engine/engine_test.h"

namespace vantage::displacement_io_test {

/// 3×2 displacements; at (2, 0) and (0, 1) one component is unknown.
struct Displacements {
  DisparityMap x{3, 2};
  DisparityMap y{3, 2};

  Displacements() {
    const float xs[] = {0, 1.5F, 2, 7, -3, 4};
    const float ys[] = {1, -2, kUnknown, 0, 0.25F, -1};
    for (int i = 0; i < 6; ++i) {
      x.at(i % 3, i / 3) = xs[i];
      y.at(i % 3, i / 3) = ys[i];
    }
    x.at(0, 1) = std::numeric_limits<float>::infinity();
  }
  [[nodiscard]] DisplacementView view() const { return {x.view(), y.view()}; }
};

std::vector<float> floats_from(const std::vector<std::uint8_t>& bytes, std::size_t offset) {
  std::vector<float> values((bytes.size() - offset) / sizeof(float));
  std::memcpy(values.data(), bytes.data() + offset, values.size() * sizeof(float));
  return values;
}

TEST(DisplacementIo, FloIsTheFlowToThePartner) {
  const TemporaryFolder folder;
  const Displacements displacements;
  write_displacements(folder / "d.flo", displacements.view(), Side::kLeft);
  const std::vector<std::uint8_t> bytes = bytes_of(folder / "d.flo");
  ASSERT_EQ(bytes.size(), 12U + 3 * 2 * 8);
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 4), "PIEH");
  EXPECT_EQ(floats_from(bytes, 0)[0], 202021.25F);  // the same four bytes as a float
  EXPECT_THAT(std::vector<int>(bytes.begin() + 4, bytes.begin() + 12),
              testing::ElementsAre(3, 0, 0, 0, 2, 0, 0, 0));
  const float none = 1e10F;
  const std::vector<float> values = floats_from(bytes, 12);
  EXPECT_EQ(values, (std::vector<float>{0, -1, -1.5F, 2, none, none,  //
                                        none, none, 3, -0.25F, -4, 1}));
  EXPECT_FALSE(std::signbit(values[0]));
  write_displacements(folder / "r.flo", displacements.view(), Side::kRight);
  EXPECT_EQ(floats_from(bytes_of(folder / "r.flo"), 12),
            (std::vector<float>{0, 1, 1.5F, -2, none, none,  //
                                none, none, -3, 0.25F, 4, -1}));
}

TEST(DisplacementIo, NpyHasTwoChannels) {
  const TemporaryFolder folder;
  write_displacements(folder / "d.npy", Displacements().view(), Side::kLeft);
  const std::vector<std::uint8_t> bytes = bytes_of(folder / "d.npy");
  const std::string text(bytes.begin(), bytes.end());
  EXPECT_THAT(text, HasSubstr("'shape': (2, 3, 2), "));
  const std::size_t payload = 3 * 2 * 2 * sizeof(float);
  ASSERT_EQ(bytes.size() % 64, payload % 64);
  const std::vector<float> values = floats_from(bytes, bytes.size() - payload);
  EXPECT_EQ(values[2], -1.5F);
  EXPECT_EQ(values[3], 2);
  EXPECT_TRUE(std::isnan(values[4]) && std::isnan(values[5]));
  EXPECT_TRUE(std::isnan(values[6]) && std::isnan(values[7]));
  EXPECT_EQ(values[11], 1);
}

TEST(DisplacementIo, PicturesHaveAThirdChannelOfValidity) {
  const TemporaryFolder folder;
  for (const char* name : {"d.tiff", "d.exr"}) {
    write_displacements(folder / name, Displacements().view(), Side::kLeft);
    const Photograph picture = read_photograph(folder / name);
    const auto& values = std::get<Image<float>>(picture.pixels);
    ASSERT_EQ(values.channels(), 3);
    ASSERT_EQ(values.width(), 3);
    const auto pixel = [&](int x, int y) {
      return std::vector<float>{values.at(x, y, 0), values.at(x, y, 1), values.at(x, y, 2)};
    };
    EXPECT_EQ(pixel(1, 0), (std::vector<float>{-1.5F, 2, 1})) << name;
    EXPECT_EQ(pixel(2, 0), (std::vector<float>{0, 0, 0})) << name;
    EXPECT_EQ(pixel(2, 1), (std::vector<float>{-4, 1, 1})) << name;
  }
}

TEST(DisplacementIo, RefusesWhatHoldsOneComponent) {
  const TemporaryFolder folder;
  const Displacements displacements;
  for (const char* name : {"d.pfm", "d.png", "d"}) {
    EXPECT_THROW(write_displacements(folder / name, displacements.view(), Side::kLeft), UsageError);
  }
  const DisparityMap small(2, 2);
  EXPECT_THAT(
      error_of([&] {
        write_displacements(folder / "d.flo", {displacements.x.view(), small.view()}, Side::kLeft);
      }),
      HasSubstr("one size"));
  EXPECT_EQ(folder.entries(), 0U);
}

}  // namespace vantage::displacement_io_test
