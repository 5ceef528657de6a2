#include "engine/options/given_map_settings.h"

#include "engine/error.h"
#include "engine/io/maps/map_io.h"
#include "engine/reprojection/map_camera.h"

namespace vantage {

void GivenMapOptions::validate(const Settings& settings) const {
  require_above_0("disparity-scale", disparity_scale);
  require_above_0("depth-scale", depth_scale);
  if (holds_depths()) {
    settings.refuse_idle({"disparity-scale"}, "with --given depth");
  } else {
    settings.refuse_idle({"depth-scale"}, "without --given depth");
  }
}

void add_given_map_settings(Settings& settings, GivenMapOptions& options) {
  settings.choice<MapQuantity>(
      "given", options.quantity,
      {{"disparity", MapQuantity::kDisparity}, {"depth", MapQuantity::kDepth}},
      "What given maps hold; depth: turned into disparities with the cameras");
  settings.number("disparity-scale", options.disparity_scale, "S",
                  "Divide values of integer disparity files by S: 16 for OpenCV's maps; auto: 256 "
                  "for 16-bit PNG");
  settings.number(
      "depth-scale", options.depth_scale, "S",
      "Values per metre with --given depth; auto: 1000 for integers (mm), 1 for floats");
}

DisparityMap read_given_map(const std::string& path, const GivenMapOptions& options,
                            const std::function<DepthScale(int width_px, int height_px)>& camera,
                            Execution& execution, std::vector<Remark>& remarks) {
  if (!options.holds_depths()) {
    return read_disparity(path, options.disparity_scale.value_or(0), &remarks);
  }
  const Image<float> depth_m = read_depth(path, options.depth_scale.value_or(0), &remarks);
  DisparityMap disparity_px;
  disparity_map(depth_m.view(), camera(depth_m.width(), depth_m.height()), execution, disparity_px);
  return disparity_px;
}

}  // namespace vantage
