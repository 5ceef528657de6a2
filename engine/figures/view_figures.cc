#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "engine/evaluation/view_evaluation.h"
#include "engine/figures/figure_families.h"
#include "engine/figures/figure_images.h"
#include "engine/figures/scene_maps.h"
#include "engine/synthesis/view_synthesizer.h"

namespace vantage {
namespace {

constexpr double kViewPicture = 350;

DisparityMaps dense_maps(const FigureImages& images, const FigureRun& run,
                         const std::string& method) {
  return scene_maps(images,
                    scene_options(run.settings, method, run.settings.iterations.front(),
                                  images.disparities, true),
                    run.execution);
}

FigureContent show_maps_of(BookImages which, bool with_photographs, const FigureRun& run) {
  const auto images = images_of(which, run);
  FigureContent content{.images = images->description};
  FigureTable table{"", {"method", "bad_0_5_percent", "bad_1_percent", "bad_2_percent", "rms_px"}};
  std::vector<SheetPicture> pictures;
  if (with_photographs) {
    pictures.push_back(photograph_picture(*images, "left", images->left));
    pictures.push_back(photograph_picture(*images, "right", images->right));
  }
  for (const std::string& method : run.settings.methods) {
    const DisparityMaps maps = dense_maps(*images, run, method);
    pictures.push_back(map_picture(*images, method + ": d12", maps.left.disparity_px.view()));
    pictures.push_back(map_picture(*images, method + ": d21", maps.right.disparity_px.view()));
    std::vector<std::string> row = {method};
    std::ranges::move(score_fields(*images, maps.left.disparity_px.view()),
                      std::back_inserter(row));
    table.rows.push_back(std::move(row));
  }
  content.pictures.push_back(
      {"", draw_picture_sheet("Photographs and disparity maps (lighter: nearer)", pictures, 2,
                              kViewPicture)});
  content.tables.push_back(std::move(table));
  return content;
}

/// As the book makes views: pixels moved to the nearest position, no soft outlines.
SynthesisOptions book_synthesis(HoleFilling holes) {
  return {.warp = WarpColour::kForward, .holes = holes, .soft_edges = false};
}

FigureContent make_views(BookImages which, HoleFilling holes, const std::vector<double>& positions,
                         const FigureRun& run) {
  const auto images = images_of(which, run);
  FigureContent content{.images = images->description};
  FigureTable table{"",
                    {"method", "view_x", "holes_percent", "psnr_db", "ssim",
                     "mean_absolute_difference_grey_levels"}};
  std::vector<SheetPicture> pictures;
  const ViewSynthesizer synthesizer(book_synthesis(holes), run.execution);
  for (const std::string& method : run.settings.methods) {
    const DisparityMaps maps = dense_maps(*images, run, method);
    double extreme_holes = 0;
    double centre_holes = 0;
    for (const double position : positions) {
      std::string title = fmt::format("{}: view from {:.2g}", method, position);
      if (position == 0 || position == 1) {
        pictures.push_back(
            photograph_picture(*images, position == 0 ? "left (original)" : "right (original)",
                               position == 0 ? images->left : images->right));
        continue;
      }
      SynthesizedView view;
      synthesizer.synthesize({images->left, images->right, maps.left.disparity_px.view(),
                              maps.right.disparity_px.view()},
                             position, view);
      const double holes_percent = 100 * view.hole_fraction;
      (position > 0 && position < 1 ? centre_holes : extreme_holes) =
          std::max(position > 0 && position < 1 ? centre_holes : extreme_holes, holes_percent);
      std::vector<std::string> row = {
          method, fmt::format("{}", position), fmt::format("{:.3f}", holes_percent), "", "", ""};
      const auto truth = images->view ? images->view(position) : std::nullopt;
      if (truth) {
        const ViewScores scores = evaluate_view(view.image, *truth, run.execution);
        row[3] = fmt::format("{:.2f}", scores.psnr_db);
        row[4] = scores.ssim ? fmt::format("{:.4f}", *scores.ssim) : "";
        row[5] = fmt::format("{:.3f}", scores.mean_absolute_difference);
        title += fmt::format(", {:.1f} dB", scores.psnr_db);
      }
      pictures.push_back(photograph_picture(*images, title, view.image));
      if (truth && positions.size() == 1) {
        pictures.push_back(photograph_picture(*images, "the scene from there", *truth));
      }
      table.rows.push_back(std::move(row));
    }
    if (positions.size() > 1) {
      content.comparisons.push_back(
          {method + ": holes of the centre view and of the extreme views",
           "many fewer in the centre view",
           fmt::format("{:.2f} % and up to {:.2f} % of the pixels", centre_holes, extreme_holes)});
    }
  }
  const int columns = positions.size() > 1 ? 3 : 2;
  content.pictures.push_back({"", draw_picture_sheet("Views along the baseline (0: left, 1: right)",
                                                     pictures, columns, kViewPicture)});
  content.tables.push_back(std::move(table));
  return content;
}

const std::vector<double> kFiveViews = {-0.5, 0, 0.5, 1, 1.5};

}  // namespace

std::vector<BookFigure> view_figures() {
  const auto settings_for = [](BookImages images) {
    return FigureSettings{
        .size_px = default_width(images), .iterations = {10}, .methods = {"gradient"}, .seed = 1};
  };
  const FigureSettings kids = settings_for(BookImages::kKids);
  const FigureSettings birch = settings_for(BookImages::kBirch);
  return {
      {.key = "3.4",
       .section = "3.3",
       .title = "The pair kids and its disparity maps",
       .book = "Left and right image (350x236) and both dense maps by the method of chapter 5; "
               "disparities 4 to 48.",
       .defaults = kids,
       .images = BookImages::kKids,
       .make = [](const FigureRun& run) { return show_maps_of(BookImages::kKids, true, run); }},
      {.key = "3.5",
       .section = "3.3",
       .title = "Views of kids along the baseline, holes black",
       .book = "Five views half a baseline apart; the second and fourth are the photographs. "
               "The centre view has many fewer holes than the extreme ones.",
       .defaults = kids,
       .images = BookImages::kKids,
       .make =
           [](const FigureRun& run) {
             return make_views(BookImages::kKids, HoleFilling::kNone, kFiveViews, run);
           }},
      {.key = "3.6",
       .section = "3.3",
       .title = "Views of kids along the baseline, holes mirrored",
       .book = "As Fig. 3.5 with holes filled by mirroring the intensities beside them along "
               "scanlines; some artifacts are noticeable.",
       .defaults = kids,
       .images = BookImages::kKids,
       .make =
           [](const FigureRun& run) {
             return make_views(BookImages::kKids, HoleFilling::kMirror, kFiveViews, run);
           }},
      {.key = "3.7",
       .section = "3.3",
       .title = "The pair birch",
       .book = "Left and right image.",
       .defaults = {.size_px = default_width(BookImages::kBirch), .seed = 1},
       .images = BookImages::kBirch,
       .make =
           [](const FigureRun& run) {
             return show_pair(BookImages::kBirch, "Pair", {"left", "right"}, kViewPicture, run);
           }},
      {.key = "3.8",
       .section = "3.3",
       .title = "Disparity maps of birch",
       .book = "Both maps, which contain many errors.",
       .defaults = birch,
       .images = BookImages::kBirch,
       .make = [](const FigureRun& run) { return show_maps_of(BookImages::kBirch, false, run); }},
      {.key = "3.9",
       .section = "3.3",
       .title = "Centre view of birch",
       .book = "A view from between the cameras: fairly realistic in spite of poor maps.",
       .defaults = birch,
       .images = BookImages::kBirch,
       .make = [](const FigureRun& run) {
         return make_views(BookImages::kBirch, HoleFilling::kMirror, {0.5}, run);
       }}};
}

}  // namespace vantage
