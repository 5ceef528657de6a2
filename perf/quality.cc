// Quality on real photographs with truth: bad pixels of the left map, and likeness of synthesised
// in-between views to the real ones, for SSD maps, OpenCV's StereoSGBM maps and the true maps in
// the same warp. Needs the scenes of the folder given as the only argument (default: beside the
// repository); says which are missing.

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "engine/evaluation/disparity_evaluation.h"
#include "engine/evaluation/view_evaluation.h"
#include "engine/io/disparity_io.h"
#include "engine/io/photograph_io.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/refinement/refinement.h"
#include "engine/synthesis/view_synthesizer.h"
#include "perf/peers.h"

namespace vantage::perf {
namespace {

struct RealView {
  std::string file;
  double x;  // in baselines
};

struct Scene {
  std::string name;
  std::string left, right, left_truth, right_truth;
  double scale;
  DisparityRange range;
  std::vector<RealView> between;
};

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> list = {
      {"cones", "im2.png", "im6.png", "disp2.png", "disp6.png", 4, {0, 63}, {{"im4.png", 0.5}}},
      {"aloe",
       "view1.png",
       "view5.png",
       "disp1.png",
       "disp5.png",
       2,
       {0, 111},
       {{"view2.png", 0.25}, {"view3.png", 0.5}, {"view4.png", 0.75}}},
      {"art",
       "view1.png",
       "view5.png",
       "disp1.png",
       "disp5.png",
       2,
       {0, 127},
       {{"view2.png", 0.25}, {"view3.png", 0.5}, {"view4.png", 0.75}}},
      {"venus",
       "im2.ppm",
       "im6.ppm",
       "disp2.pgm",
       "disp6.pgm",
       8,
       {0, 31},
       {{"im3.ppm", 0.25}, {"im4.ppm", 0.5}, {"im5.ppm", 0.75}}},
  };
  return list;
}

struct Maps {
  std::string name;
  DisparityMap left;
  DisparityMap right;
};

/// Cross-check and fill as the engine does it after matching.
void refine(Maps& maps, DisparityRange range, Execution& execution) {
  MatchOptions options;
  options.disparities = range;
  Mask left_unmatched;
  Mask right_unmatched;
  cross_check(maps.left.view(), maps.right.view(), options.resolved_refinement().cross_check_px,
              execution, left_unmatched, right_unmatched);
  fill_unmatched(left_unmatched, MapSide::kLeft, Fill::kConstant, execution, maps.left);
  fill_unmatched(right_unmatched, MapSide::kRight, Fill::kConstant, execution, maps.right);
}

Maps ssd_maps(const Photograph& left, const Photograph& right, DisparityRange range,
              Execution& execution) {
  MatchOptions options;
  options.disparities = range;
  DisparityMaps maps;
  StereoMatcher(options, execution).match(left, right, {}, maps);
  return {"Vantage SSD 9x9", std::move(maps.left), std::move(maps.right)};
}

/// With the refinement that suits photographs better than the book's.
Maps strict_ssd_maps(const Photograph& left, const Photograph& right, DisparityRange range,
                     Execution& execution) {
  MatchOptions options;
  options.disparities = range;
  options.refinement.cross_check_px = 1;
  options.refinement.speckle_size_px = 100;
  DisparityMaps maps;
  StereoMatcher(options, execution).match(left, right, {}, maps);
  return {"Vantage SSD strict", std::move(maps.left), std::move(maps.right)};
}

Maps opencv_maps(const Photograph& left, const Photograph& right, DisparityRange range,
                 Execution& execution) {
  PeerMaps sgbm = sgbm_maps(to_opencv(left), to_opencv(right), range, 5, cv::StereoSGBM::MODE_SGBM);
  Maps maps{"OpenCV StereoSGBM", std::move(sgbm.left), std::move(sgbm.right)};
  refine(maps, range, execution);
  return maps;
}

/// Pixels whose truth is known and visible in the other image.
Mask visible_in_both(const Maps& truth, Execution& execution) {
  Mask left;
  Mask right;
  cross_check(truth.left.view(), truth.right.view(), 1.0, execution, left, right);
  for (int y = 0; y < left.height(); ++y) {
    for (int x = 0; x < left.width(); ++x) {
      left.at(x, y) = static_cast<std::uint8_t>(255 - left.at(x, y));
    }
  }
  return left;
}

void report(const Scene& scene, const std::filesystem::path& folder, Execution& execution) {
  const Photograph left = read_photograph(folder / scene.left);
  const Photograph right = read_photograph(folder / scene.right);
  Maps truth{"true maps", read_disparity(folder / scene.left_truth, scene.scale),
             read_disparity(folder / scene.right_truth, scene.scale)};
  const Mask visible = visible_in_both(truth, execution);
  const DisparityMap left_truth = truth.left.copy();
  refine(truth, scene.range, execution);  // fills what the truth does not know

  std::vector<Maps> contenders;
  contenders.push_back(ssd_maps(left, right, scene.range, execution));
  contenders.push_back(strict_ssd_maps(left, right, scene.range, execution));
  contenders.push_back(opencv_maps(left, right, scene.range, execution));
  contenders.push_back(std::move(truth));
  for (const Maps& maps : contenders) {
    std::string bad(41, ' ');
    if (&maps != &contenders.back()) {
      const auto seen =
          evaluate_disparity(maps.left.view(), left_truth.view(), {.mask = visible.view()});
      const auto all = evaluate_disparity(maps.left.view(), left_truth.view(), {});
      bad = fmt::format(" {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f} ", seen.bad_1_percent,
                        seen.bad_2_percent, all.bad_1_percent, all.bad_2_percent);
    }
    double psnr = 0;
    double ssim = 0;
    for (const RealView& between : scene.between) {
      SynthesizedView view;
      ViewSynthesizer({}, execution)
          .synthesize(left, right, maps.left.view(), maps.right.view(), between.x, view);
      const ViewScores scores =
          evaluate_view(view.image, read_photograph(folder / between.file), execution);
      psnr += scores.psnr_db / static_cast<double>(scene.between.size());
      ssim += scores.ssim.value_or(0) / static_cast<double>(scene.between.size());
    }
    fmt::print("{:<8} {:<18}{} {:>8.2f} {:>8.4f}\n", scene.name, maps.name, bad, psnr, ssim);
  }
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) {
  using namespace vantage;
  const std::filesystem::path data = argc > 1 ? argv[1] : VANTAGE_SHARED_DATA;
  Execution execution({});
  fmt::print("{:<8} {:<18} {:>19} {:>19}\n", "", "", "visible in both", "all known");
  fmt::print("{:<8} {:<18} {:>9} {:>9} {:>9} {:>9}  {:>8} {:>8}\n", "scene", "maps", "bad 1 %",
             "bad 2 %", "bad 1 %", "bad 2 %", "PSNR dB", "SSIM");
  for (const perf::Scene& scene : perf::scenes()) {
    if (std::filesystem::exists(data / scene.name)) {
      perf::report(scene, data / scene.name, execution);
    } else {
      fmt::print("{:<8} left out: no folder {}\n", scene.name, (data / scene.name).string());
    }
  }
  return 0;
}
