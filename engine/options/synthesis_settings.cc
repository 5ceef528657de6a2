#include "engine/options/synthesis_settings.h"

namespace vantage {

void add_synthesis_settings(Settings& settings, SynthesisOptions& options) {
  settings.start_group("View synthesis");
  settings.choice<WarpColour>(
      "warp", options.warp, {{"one-pass", WarpColour::kOnePass}, {"forward", WarpColour::kForward}},
      "Colours of views. one-pass: one bicubic interpolation of the photograph; forward: whole "
      "pixels are moved, as in Scharstein's book (with cameras: between rectification and its "
      "inverse)");
  add_holes_setting(settings, options.holes);
  add_soft_edges_setting(settings, options.soft_edges);
  add_combining_settings(settings, options);
}

void add_soft_edges_setting(Settings& settings, bool& soft_edges) {
  settings.choice<bool>(
      "soft-edges", soft_edges, {{"on", true}, {"off", false}},
      "Blend the edges of objects as in a photograph, without remains of their old background");
}

void add_holes_setting(Settings& settings, HoleFilling& holes) {
  settings.choice<HoleFilling>(
      "holes", holes,
      {{"interpolate", HoleFilling::kInterpolate},
       {"mirror", HoleFilling::kMirror},
       {"spread", HoleFilling::kSpread},
       {"inpaint", HoleFilling::kInpaint},
       {"texture", HoleFilling::kTexture},
       {"none", HoleFilling::kNone}},
      "How areas that no image shows are filled: means of the background (interpolate), its row "
      "mirrored (mirror), its last pixel (spread), painting (inpaint), patches (texture), black "
      "(none)");
}

void add_combining_settings(Settings& settings, SynthesisOptions& options) {
  settings.number("gamma", options.gamma, "G",
                  "Brightness of views, 0 to 1: 1 as the left image, 0 as the right image; alpha: "
                  "by the position of the view",
                  "alpha");
  add_surface_settings(settings, options);
}

void check_combining(const Settings& settings, const SynthesisOptions& options) {
  if (!options.match_intensities) {
    settings.refuse_idle({"gamma"}, "with --no-intensity-matching");
  }
}

void add_surface_settings(Settings& settings, SynthesisOptions& options) {
  settings.number(
      "gradient-limit", options.disparity_gradient_limit_px, "PX",
      "Neighbouring pixels belong to one surface if their disparities differ by at most PX");
  Setting& no_matching =
      settings.add("no-intensity-matching", "", "Do not match the brightness of the images");
  no_matching.kind = ValueKind::kTruth;
  no_matching.set = [&options](const SettingValue& value) {
    options.match_intensities = !to_truth(value);
  };
  no_matching.get = [&options] { return !options.match_intensities; };
}

}  // namespace vantage
