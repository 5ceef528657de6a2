#include "perf/quality/view_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "engine/error.h"
#include "engine/evaluation/view_evaluation.h"
#include "engine/io/images/photograph_io.h"
#include "engine/synthesis/view_synthesizer.h"
#include "perf/quality/markdown.h"
#include "perf/quality/scene_groups.h"
#include "perf/view_scenes.h"

namespace vantage::perf {
namespace {

/// Results of one view, or means over several.
struct ViewFigures {
  double psnr_db = 0;
  double ssim = 0;
};

/// Means over a scene's views between the cameras.
ViewFigures view_figures(const ViewScene& scene, const std::filesystem::path& folder,
                         const ScenePair& pair, const DisparityMaps& maps, Execution& execution) {
  const ViewSynthesizer synthesizer({}, execution);
  SynthesizedView made;
  ViewFigures sum;
  double views = 0;
  for (const RealView& view : scene.views) {
    if (view.x <= 0 || view.x >= 1) {
      continue;
    }
    synthesizer.synthesize(
        {pair.left, pair.right, maps.left.disparity_px.view(), maps.right.disparity_px.view()},
        view.x, made);
    const ViewScores scores =
        evaluate_view(made.image, read_photograph(folder / view.file), execution);
    sum.psnr_db += scores.psnr_db;
    sum.ssim += scores.ssim.value_or(0);
    ++views;
  }
  return {sum.psnr_db / views, sum.ssim / views};
}

/// The source of the maps, and the results per scene.
struct Line {
  std::string name;
  std::vector<ViewFigures> of_scenes;
};

ViewFigures mean(const Line& line, const SceneGroup& group) {
  ViewFigures sum;
  for (const std::size_t scene : group.scenes) {
    sum.psnr_db += line.of_scenes[scene].psnr_db;
    sum.ssim += line.of_scenes[scene].ssim;
  }
  const auto n = static_cast<double>(group.scenes.size());
  return {sum.psnr_db / n, sum.ssim / n};
}

/// Cells of one table: "PSNR / SSIM".
std::string text(const ViewFigures& figures) {
  return cell(figures.psnr_db, 2) + " / " + cell(figures.ssim, 4);
}

void print_lines(const std::vector<Line>& lines, const std::vector<const TrueScene*>& scenes) {
  const std::vector<SceneGroup> groups = scene_groups(scenes);
  std::vector<std::string> titles;
  for (const SceneGroup& group : groups) {
    titles.push_back(group.name);
  }
  fmt::print("\nViews between the cameras, PSNR in dB / SSIM, means over scenes:\n\n");
  print_header(titles);
  for (const Line& line : lines) {
    fmt::print("| {} |", line.name);
    for (const SceneGroup& group : groups) {
      fmt::print(" {} |", text(mean(line, group)));
    }
    fmt::print("\n");
  }
  titles.clear();
  for (const TrueScene* scene : scenes) {
    titles.push_back(scene->name);
  }
  fmt::print("\nThe same by scene:\n\n");
  print_header(titles);
  for (const Line& line : lines) {
    fmt::print("| {} |", line.name);
    for (const ViewFigures& figures : line.of_scenes) {
      fmt::print(" {} |", text(figures));
    }
    fmt::print("\n");
  }
}

}  // namespace

void print_view_tables(const std::vector<MapContender>& contenders,
                       const std::vector<const TrueScene*>& scenes,
                       const std::filesystem::path& data, Execution& execution) {
  std::vector<Line> lines = {{"truth", {}}};
  for (const MapContender& contender : contenders) {
    lines.push_back({contender.name, {}});
  }
  std::vector<const TrueScene*> with_views;
  for (const TrueScene* scene : scenes) {
    const auto views = std::ranges::find(view_scenes(), scene->name, &ViewScene::name);
    if (views == view_scenes().end()) {
      continue;
    }
    fmt::print(stderr, "views of {}\n", scene->name);
    with_views.push_back(scene);
    const std::filesystem::path folder = data / views->name;
    const ScenePair pair = make_scene_pair(read_photograph(folder / views->left),
                                           read_photograph(folder / views->right), views->range);
    lines[0].of_scenes.push_back(
        view_figures(*views, folder, pair, true_maps(*views, folder, execution), execution));
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      const std::unique_ptr<MapMaker> maker = contenders[i].prepare(pair, execution);
      maker->match(TimedMaps::kBoth);
      lines[i + 1].of_scenes.push_back(
          view_figures(*views, folder, pair, maker->maps(), execution));
    }
  }
  if (with_views.empty()) {
    throw UsageError("none of the scenes has photographs between its cameras");
  }
  print_lines(lines, with_views);
}

}  // namespace vantage::perf
