#include "engine/io/maps/map_formats.h"

#include "engine/io/maps/map_io.h"
#include "tests/engine/engine_test.h"

namespace vantage::map_formats_test {

TEST(MapFormats, AreFoundByExtensionAndContent) {
  EXPECT_NE(find_map_format("a/b.PFM", MapContent::kDisparity), nullptr);
  EXPECT_NE(find_map_format("a.Tif", MapContent::kDisplacements), nullptr);
  EXPECT_EQ(find_map_format("a.png", MapContent::kConfidence), nullptr);
  EXPECT_EQ(find_map_format("a.pfm", MapContent::kDisplacements), nullptr);
  EXPECT_EQ(find_map_format("a.flo", MapContent::kDisparity), nullptr);
  EXPECT_EQ(find_map_format("pfm", MapContent::kDisparity), nullptr);
}

TEST(MapFormats, AreListedForMessages) {
  EXPECT_EQ(listed_map_formats(MapContent::kDisparity), ".pfm, .png, .tiff, .exr or .npy");
  EXPECT_EQ(listed_map_formats(MapContent::kDisplacements), ".flo, .tiff, .exr or .npy");
  EXPECT_EQ(listed_map_formats(MapContent::kConfidence, ""), "pfm, tiff, exr or npy");
}

/// Every line of the table writes files of its extension.
TEST(MapFormats, WriteWhatTheyCanHold) {
  const TemporaryFolder folder;
  DisparityMap map(3, 2);
  map.fill(1.5F);
  for (const MapFormat& format : map_formats()) {
    const auto path = folder / ("map" + std::string(format.extension));
    if (format.can_hold(MapContent::kDisparity)) {
      write_disparity(path, map.view());
      EXPECT_EQ(read_disparity(path).at(2, 1), 1.5F) << format.extension;
    }
    if (format.can_hold(MapContent::kDisplacements)) {
      write_displacements(path, {map.view(), map.view()}, Side::kLeft);
      EXPECT_GT(std::filesystem::file_size(path), 3U * 2 * 2 * 2) << format.extension;
    }
  }
}

}  // namespace vantage::map_formats_test
