// Similarity of synthesised views to real photographs. For every scene with photographs between and
// beside the cameras of its pair: views from the true maps (one-pass and forward warp, and a simple
// hand-written warp; without soft edges and with other hole filling), from the maps of the presets
// (for `balanced` also moved forward and with other filling) and of OpenCV's StereoSGBM. Measured
// over the whole image, and near the outlines that the true maps have in the view. Prints Markdown
// tables. The only argument is the folder of the scenes (default: beside the repository); missing
// scenes are named.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/evaluation/view_evaluation.h"
#include "engine/io/images/photograph_io.h"
#include "engine/synthesis/view_synthesizer.h"
#include "perf/command_line.h"
#include "perf/default_paths.h"
#include "perf/outlines.h"
#include "perf/peers.h"
#include "perf/plain_view.h"
#include "perf/view_scenes.h"

namespace vantage::perf {
namespace {

struct LoadedPair {
  const ViewScene* scene;
  Photograph left;
  Photograph right;
};

using MakeMaps = std::function<DisparityMaps(const LoadedPair&, Execution&)>;
using MakeView =
    std::function<Photograph(const LoadedPair&, const DisparityMaps&, double view_x, Execution&)>;

struct Contender {
  std::string name;
  std::string maps;  ///< key of the maps
  MakeView view;
};

MakeView ours(const SynthesisOptions& options) {
  return [options](const LoadedPair& pair, const DisparityMaps& maps, double view_x,
                   Execution& execution) {
    SynthesizedView view;
    ViewSynthesizer(options, execution)
        .synthesize(
            {pair.left, pair.right, maps.left.disparity_px.view(), maps.right.disparity_px.view()},
            view_x, view);
    return std::move(view.image);
  };
}

MakeMaps preset(MatchPreset kind, std::optional<Fill> fill = {}) {
  return [kind, fill](const LoadedPair& pair, Execution& execution) {
    MatchOptions options;
    options.preset = kind;
    options.refinement.fill = fill;
    options.disparities = pair.scene->range;
    DisparityMaps maps;
    StereoMatcher(options, execution).match(pair.left, pair.right, {}, maps);
    return maps;
  };
}

/// Cross-checks within a pixel and fills, like our own maps.
DisparityMaps opencv_maps(const LoadedPair& pair, Execution& execution) {
  PeerMaps sgbm = sgbm_maps(to_opencv(pair.left), to_opencv(pair.right), pair.scene->range, 5,
                            cv::StereoSGBM::MODE_SGBM);
  DisparityMaps maps;
  maps.left.disparity_px = std::move(sgbm.left);
  maps.right.disparity_px = std::move(sgbm.right);
  Mask left;
  Mask right;
  cross_check(maps.left.disparity_px.view(), maps.right.disparity_px.view(), Side::kLeft, 1,
              execution, left);
  cross_check(maps.right.disparity_px.view(), maps.left.disparity_px.view(), Side::kRight, 1,
              execution, right);
  fill_unmatched(left, Side::kLeft, Fill::kConstant, execution, maps.left.disparity_px);
  fill_unmatched(right, Side::kRight, Fill::kConstant, execution, maps.right.disparity_px);
  return maps;
}

const std::vector<Contender>& contenders() {
  static const std::vector<Contender> list = {
      {"truth, one-pass", "truth", ours({})},
      {"hard edges", "truth", ours({.soft_edges = false})},
      {"mirror", "truth", ours({.holes = HoleFilling::kMirror})},
      {"spread", "truth", ours({.holes = HoleFilling::kSpread})},
      {"inpaint", "truth", ours({.holes = HoleFilling::kInpaint})},
      {"texture", "truth", ours({.holes = HoleFilling::kTexture})},
      {"forward", "truth", ours({.warp = WarpColour::kForward})},
      {"plain z-buffer", "truth",
       [](const LoadedPair& pair, const DisparityMaps& maps, double view_x, Execution& /*unused*/) {
         return plain_view(pair.left, pair.right, maps, view_x);
       }},
      {"balanced", "balanced", ours({})},
      {"balanced, forward", "balanced", ours({.warp = WarpColour::kForward})},
      {"balanced, hard edges", "balanced", ours({.soft_edges = false})},
      {"balanced, mirror", "balanced", ours({.holes = HoleFilling::kMirror})},
      {"balanced, inpaint", "balanced", ours({.holes = HoleFilling::kInpaint})},
      {"balanced, texture", "balanced", ours({.holes = HoleFilling::kTexture})},
      {"balanced, median", "balanced, median", ours({})},
      {"quality", "quality", ours({})},
      {"StereoSGBM", "sgbm", ours({})},
  };
  return list;
}

struct Score {
  double psnr_db = 0;
  double ssim = 0;
  double psnr_near_outlines_db = 0;
};

/// Scores of all contenders for one view, or their means over several.
struct Line {
  std::string name;
  bool is_between = false;  ///< between the cameras
  std::vector<Score> scores;
};

Score score(const Photograph& made, const Photograph& photograph, const Mask& near,
            Execution& execution) {
  const ViewScores all = evaluate_view(made, photograph, execution);
  return {all.psnr_db, all.ssim.value_or(0),
          evaluate_view(made, photograph, execution, near.view()).psnr_db};
}

Line mean(const std::string& name, bool is_between, const std::vector<Line>& lines) {
  Line result{name, is_between, std::vector<Score>(contenders().size())};
  const auto count = static_cast<double>(std::count_if(
      lines.begin(), lines.end(), [&](const Line& line) { return line.is_between == is_between; }));
  for (const Line& line : lines) {
    for (std::size_t i = 0; i < contenders().size() && line.is_between == is_between; ++i) {
      result.scores[i].psnr_db += line.scores[i].psnr_db / count;
      result.scores[i].ssim += line.scores[i].ssim / count;
      result.scores[i].psnr_near_outlines_db += line.scores[i].psnr_near_outlines_db / count;
    }
  }
  return result;
}

void print_table(const std::string& title, const std::vector<Line>& lines,
                 const std::function<std::string(const Score&)>& cell) {
  fmt::print("\n{}\n\n| scene, XS |", title);
  for (const Contender& contender : contenders()) {
    fmt::print(" {} |", contender.name);
  }
  fmt::print("\n|---|");
  for (std::size_t i = 0; i < contenders().size(); ++i) {
    fmt::print("---|");
  }
  fmt::print("\n");
  for (const Line& line : lines) {
    fmt::print("| {} |", line.name);
    for (const Score& value : line.scores) {
      fmt::print(" {} |", cell(value));
    }
    fmt::print("\n");
  }
}

void measure(const ViewScene& scene, const std::filesystem::path& folder, Execution& execution,
             std::vector<Line>& lines) {
  const LoadedPair pair{&scene, read_photograph(folder / scene.left),
                        read_photograph(folder / scene.right)};
  std::map<std::string, DisparityMaps> maps;
  maps["truth"] = true_maps(scene, folder, execution);
  maps["balanced"] = preset(MatchPreset::kBalanced)(pair, execution);
  maps["balanced, median"] = preset(MatchPreset::kBalanced, Fill::kMedian)(pair, execution);
  maps["quality"] = preset(MatchPreset::kQuality)(pair, execution);
  maps["sgbm"] = opencv_maps(pair, execution);
  for (const RealView& view : scene.views) {
    const Photograph photograph = read_photograph(folder / view.file);
    const Mask near = near_outlines(seen_from(maps["truth"], view.x));
    Line line{fmt::format("{} {:+.2f}", scene.name, view.x), view.x > 0 && view.x < 1, {}};
    for (const Contender& contender : contenders()) {
      const Photograph made = contender.view(pair, maps[contender.maps], view.x, execution);
      line.scores.push_back(score(made, photograph, near, execution));
    }
    lines.push_back(std::move(line));
  }
}

}  // namespace
}  // namespace vantage::perf

int main(int argc, char** argv) {
  using namespace vantage;
  perf::CommandLine line("PSNR and SSIM of new views against photographs taken there");
  std::filesystem::path data = perf::kDefaultData;
  line.option("FOLDER", data, "Folder of the scenes");
  line.parse(argc, argv);
  Execution execution({});
  std::vector<perf::Line> lines;
  for (const perf::ViewScene& scene : perf::view_scenes()) {
    if (std::filesystem::exists(data / scene.name)) {
      perf::measure(scene, data / scene.name, execution, lines);
    } else {
      fmt::print("{} left out: no folder {}\n", scene.name, (data / scene.name).string());
    }
  }
  if (lines.empty()) {
    line.refuse("no scenes are left");
  }
  const perf::Line between = perf::mean("**mean, between the cameras**", true, lines);
  const perf::Line beside = perf::mean("**mean, beside them**", false, lines);
  lines.push_back(between);
  lines.push_back(beside);
  perf::print_table("PSNR in dB / SSIM of the whole picture against the photograph", lines,
                    [](const perf::Score& score) {
                      return fmt::format("{:.2f} / {:.3f}", score.psnr_db, score.ssim);
                    });
  perf::print_table(
      "PSNR in dB within 3 pixels of the outlines", lines,
      [](const perf::Score& score) { return fmt::format("{:.2f}", score.psnr_near_outlines_db); });
  return 0;
}
