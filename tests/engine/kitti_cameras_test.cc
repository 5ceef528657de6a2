#include "engine/rectification/kitti_cameras.h"

#include "tests/engine/engine_test.h"

namespace vantage::kitti_cameras_test {

std::optional<KittiCameras> of(std::vector<std::filesystem::path> images) {
  return kitti_cameras_of(images);
}

TEST(KittiCamerasOf, NamesOfFoldersSayThem) {
  EXPECT_EQ(of({"training/image_2/000000_10.png", "training/image_3/000000_10.png"}),
            KittiCameras::kColour);
  EXPECT_EQ(of({"image_00/data/0.png", "image_01/data/0.png"}), KittiCameras::kGrey);
  EXPECT_EQ(of({"training/colored_0/1.png", "training/colored_1/1.png"}), KittiCameras::kColour);
  EXPECT_EQ(of({"/data/image_0/old/../../image_3/x.png"}), KittiCameras::kColour);
  EXPECT_EQ(of({"image_0/image_2/x.png"}), KittiCameras::kColour) << "the innermost folder";
}

TEST(KittiCamerasOf, OneCamera) {
  const auto camera = [](std::vector<std::filesystem::path> images) {
    return kitti_camera_of(images);
  };
  EXPECT_EQ(camera({"image_2/0.png", "image_2/1.png"}), 2);
  EXPECT_EQ(camera({"image_03/data/0.png"}), 3);
  EXPECT_EQ(camera({"image_0/0.png", "list.txt"}), 0);
  EXPECT_EQ(camera({"colored_1/0.png"}), 3);
  EXPECT_FALSE(camera({"image_2/0.png", "image_3/0.png"})) << "they do not agree";
  EXPECT_FALSE(camera({"photos/0.png"}));
}

TEST(KittiCamerasOf, OtherNamesSayNothing) {
  EXPECT_FALSE(of({}));
  EXPECT_FALSE(of({""}));
  EXPECT_FALSE(of({"left/image_2.png", "right/image_3.png"}));
  EXPECT_FALSE(of({"image_0/x.png", "image_2/x.png"})) << "they do not agree";
  EXPECT_EQ(of({"image_2/x.png", "poses.csv"}), KittiCameras::kColour);
}

}  // namespace vantage::kitti_cameras_test
