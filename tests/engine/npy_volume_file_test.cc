#include "engine/io/maps/npy_volume_file.h"

#include "tests/engine/engine_test.h"

namespace vantage::npy_volume_file_test {

namespace fs = std::filesystem;

constexpr VolumeShape kShape{.width_px = 4, .height_px = 3, .disparities = {-1, 3}};

class NpyVolumeFileTest : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path path() const { return folder_ / "volume.npy"; }
  [[nodiscard]] std::string bytes() const {
    std::ifstream file(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  [[nodiscard]] std::vector<float> values() const {
    const std::string all = bytes();
    const std::size_t first = all.find('\n') + 1;
    EXPECT_EQ(first % 64, 0U);
    std::vector<float> result((all.size() - first) / sizeof(float));
    std::memcpy(result.data(), all.data() + first, all.size() - first);
    return result;
  }
  [[nodiscard]] std::size_t files() const { return folder_.entries(); }

  /// Value 100y + 10x + i, in parts from the last one on.
  static void fill(NpyVolumeFile& file, const VolumeShape& shape) {
    file.start(shape);
    for (int y = shape.height_px - 1; y >= 0; --y) {
      for (int x = shape.width_px - 2; x >= 0; x -= 2) {
        std::vector<float> part;
        for (const auto [i, column] : positions_of({0, shape.candidates()}, {x, x + 2})) {
          part.push_back(static_cast<float>(100 * y + 10 * column + i));
        }
        file.write(x, y, 2, part.data());
      }
    }
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(NpyVolumeFileTest, HoldsThePartsInOrder) {
  {
    NpyVolumeFile file(path(), std::nullopt, false);
    fill(file, kShape);
    EXPECT_FALSE(fs::exists(path()));
    file.commit();
  }
  EXPECT_THAT(bytes(), HasSubstr("'descr': '<f4', 'fortran_order': False, 'shape': (3,4,5,)"));
  const std::vector<float> all = values();
  ASSERT_EQ(all.size(), 60U);
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(all[k], static_cast<float>(100 * (k / 20) + 10 * (k / 5 % 4) + k % 5));
  }
}

TEST_F(NpyVolumeFileTest, RowsAndTransposedVolumes) {
  VolumeShape shape = kShape;
  shape.disparities = {0, 1};
  shape.disparities_y = DisparityRange{-1, 1};
  NpyVolumeFile file(path(), VolumeRows{1, 3}, true);
  fill(file, shape);
  EXPECT_EQ(file.file_shape(), (std::vector<int>{2, 3, 3, 2}));
  file.commit();
  const std::vector<float> all = values();
  ASSERT_EQ(all.size(), 36U);
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(all[k], static_cast<float>(10 * (1 + k / 18) + 100 * (k / 6 % 3) + k % 6));
  }
}

TEST_F(NpyVolumeFileTest, LeavesNothingUnlessComplete) {
  {
    NpyVolumeFile file(path(), std::nullopt, false);
    fill(file, kShape);
  }
  EXPECT_EQ(files(), 0U);
  NpyVolumeFile file(path(), VolumeRows{1, 4}, false);
  EXPECT_THROW(file.start(kShape), UsageError);
}

}  // namespace vantage::npy_volume_file_test
