#include "apps/scene/scene_images.h"

#include <fmt/format.h>

#include <memory>

#include "apps/scene/posed_scene_images.h"
#include "engine/error.h"
#include "engine/io/video/frame_source.h"
#include "engine/options/calibration_settings.h"
#include "engine/scene_graph/position_list.h"

namespace vantage::apps {
namespace {

GridSize to_grid(const SettingValue& value) {
  return from_parts(value, 'x', 2, "COLUMNSxROWS such as 5x3", [](const auto& parts) {
    const GridSize grid{to_integer(parts[0]), to_integer(parts[1])};
    const bool is_valid = grid.columns >= 1 && grid.rows >= 1 &&
                          grid.columns <= SceneLayout::kMaxVertices &&
                          grid.rows <= SceneLayout::kMaxVertices;
    return is_valid ? std::optional(grid) : std::nullopt;
  });
}

ScenePosition to_spacing(const SettingValue& value) {
  try {
    const ScenePosition spacing = to_scene_position(value);
    if (spacing.x > 0 && spacing.y > 0) {
      return spacing;
    }
  } catch (const UsageError&) {  // the message below says more
  }
  reject_value(value, "SX,SY with two lengths above 0 such as 10,12.5");
}

std::vector<SceneImage> images_on_grid(const SceneImagesInput& input) {
  const std::unique_ptr<FrameSource> source = open_frame_source(input.images);
  if (!source->video_file().empty()) {
    throw UsageError(fmt::format("--images is '{}', a video; expected image files", input.images));
  }
  const int count = source->frame_count();
  const GridSize grid = input.grid.value_or(GridSize{count, 1});
  if (static_cast<long long>(grid.columns) * grid.rows != count) {
    throw Error(fmt::format("{} has {} images, expected {} for a grid of {}x{}", input.images,
                            count, static_cast<long long>(grid.columns) * grid.rows, grid.columns,
                            grid.rows));
  }
  std::vector<SceneImage> images;
  for (int i = 0; i < count; ++i) {
    images.push_back({.file = source->describe(i),
                      .position = {.x = (i % grid.columns) * input.spacing.x,
                                   .y = (i / grid.columns) * input.spacing.y}});
  }
  return images;
}

}  // namespace

ScenePosition to_scene_position(const SettingValue& value) {
  return from_parts(value, ',', 2, "a position X,Y such as 1.5,0", [](const auto& parts) {
    return std::optional(ScenePosition{to_number(parts[0]), to_number(parts[1])});
  });
}

void add_scene_images_settings(Settings& settings, SceneImagesInput& input) {
  settings.input_path(
      "images", input.images, "SOURCE",
      "Images, row by row from the upper left: a folder, a pattern (images/%03d.png) or a glob");
  Setting& grid = settings.add("grid", "COLSxROWS", "Camera grid; row: a single row");
  grid.set = [&input](const SettingValue& value) {
    if (value.is_string() && value.get_ref<const std::string&>() == "row") {
      input.grid.reset();
    } else {
      input.grid = to_grid(value);
    }
  };
  grid.get = [&input]() -> SettingValue {
    return input.grid ? fmt::format("{}x{}", input.grid->columns, input.grid->rows) : "row";
  };
  Setting& spacing =
      settings.add("spacing", "SX,SY",
                   "Distance between neighbouring cameras along rows and columns, in any unit");
  spacing.set = [&input](const SettingValue& value) { input.spacing = to_spacing(value); };
  spacing.get = [&input]() -> SettingValue {
    return fmt::format("{},{}", input.spacing.x, input.spacing.y);
  };
  settings.input_path("positions", input.positions, "FILE.csv",
                      "List of images with positions instead of --images: lines image,x,y, with y "
                      "downwards; paths are relative to the folder of the list");
  settings.input_path(
      "poses", input.poses, "PATH",
      "Poses of hand-held cameras: a folder with a COLMAP model as text, whose images are in "
      "--images; transforms.json of NeRF tools, likewise; a TUM, KITTI or EuRoC trajectory; "
      "OpenCV's YAML or XML with extrinsic_parameters");
  settings.input_path(
      "intrinsics", input.intrinsics, "FILE",
      "Camera of a trajectory: OpenCV's YAML or XML, COLMAP's cameras.txt, KITTI's "
      "calib.txt (P2 for images in image_2, else P0), or a text fx fy cx cy [k1 k2 p1 p2 [k3]]");
  add_lens_setting(settings, input.lens);
}

std::vector<SceneImage> scene_images(const SceneImagesInput& input, const Settings& settings,
                                     std::vector<std::string>& remarks) {
  if (!input.poses.empty()) {
    settings.refuse_idle({"grid", "spacing", "positions"}, "with --poses");
    settings.refuse_idle({"rows"}, "with --poses, which say how rows correspond");
    return posed_scene_images(input.poses, input.images, input.intrinsics, input.lens, remarks);
  }
  settings.refuse_idle({"intrinsics", "lens", "neighbours"}, "without --poses");
  if (input.images.empty() == input.positions.empty()) {
    throw UsageError(input.images.empty()
                         ? "no images are given, expected --images or --positions"
                         : "--images and --positions are both given, expected one of them");
  }
  if (input.positions.empty()) {
    return images_on_grid(input);
  }
  settings.refuse_idle({"grid", "spacing"}, "with --positions");
  return read_position_list(input.positions);
}

}  // namespace vantage::apps
