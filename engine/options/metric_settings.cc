#include "engine/options/metric_settings.h"

#include <fmt/format.h>

#include "engine/error.h"

namespace vantage {

void add_max_depth_setting(Settings& settings, std::optional<double>& max_depth_m) {
  settings.number("max-depth", max_depth_m, "METRES",
                  "Discard depths beyond this; auto: no limit, 65.535 in PNG");
}

void add_disparity_resolution_setting(Settings& settings, std::optional<double>& step_px) {
  settings.number(
      "disparity-resolution", step_px, "PX",
      "Smallest distinguishable difference of disparities, for --depth-resolution; auto: "
      "0.1, or 1 with --subpixel none");
}

void require_disparity_resolution(const std::optional<double>& step_px) {
  require_above_0("disparity-resolution", step_px);
}

void add_cloud_settings(Settings& settings, CloudOptions& options) {
  add_max_depth_setting(settings, options.max_depth);
  settings.integer("cloud-step", options.step_px, "N",
                   "Points of every Nth column and row, 1 to 1024");
  settings.number("cloud-min-confidence", options.min_confidence, "C",
                  "Drop points below this confidence, see --confidence; auto: none");
  settings.flag("cloud-confidence", options.with_confidence, "Store each point's confidence");
  settings.flag("cloud-filled", options.keeps_filled,
                "Also points of filled pixels, whose disparity is a guess");
  settings.flag(
      "cloud-outlines", options.keeps_outlines,
      "Also points of pixels beside a jump of the disparity, which may mix foreground and "
      "background");
  settings.number("cloud-gradient-limit", options.gradient_limit_px, "PX",
                  "Neighbours whose disparities differ by more are two surfaces");
}

void refuse_idle_cloud_options(const Settings& settings, std::string_view why) {
  settings.refuse_idle({"cloud-step", "cloud-min-confidence", "cloud-confidence", "cloud-filled",
                        "cloud-outlines", "cloud-gradient-limit"},
                       why);
}

}  // namespace vantage
