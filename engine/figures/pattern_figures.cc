#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine/figures/figure_families.h"
#include "engine/figures/pair_runs.h"
#include "engine/image/eight_bit.h"
#include "engine/image/intensity_rows.h"
#include "engine/plot/picture_sheet.h"

namespace vantage {
namespace {

DisparityMap without_occluded(const DisparityMap& map, const Mask& occluded) {
  DisparityMap result = map.copy();
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      if (occluded.at(x, y) != 0) {
        result.at(x, y) = std::numeric_limits<float>::quiet_NaN();
      }
    }
  }
  return result;
}

/// Pixels of every disparity, and how many of them are occluded.
void add_levels(const std::string& name, const BookPair& pair, FigureTable& table) {
  std::map<float, std::pair<int, int>> levels;
  for (int y = 0; y < pair.left_disparity.height(); ++y) {
    for (int x = 0; x < pair.left_disparity.width(); ++x) {
      auto& [pixels, occluded] = levels[pair.left_disparity.at(x, y)];
      ++pixels;
      occluded += pair.left_occluded.at(x, y) != 0 ? 1 : 0;
    }
  }
  for (const auto& [disparity, counts] : levels) {
    table.add(name, disparity, counts.first, counts.second);
  }
}

FigureContent make_pattern(const FigureRun& run) {
  FigureContent content;
  FigureTable table{"", {"pair", "disparity_px", "pixels", "occluded_pixels"}};
  std::vector<SheetPicture> pictures;
  for (const std::string& name : run.settings.pairs) {
    const BookPair pair = pair_of(run.settings, name, 0);
    const auto near = static_cast<float>(pair.search.max);
    pictures.push_back({name, grey_picture(pair.left_disparity.view(), 0, near)});
    const DisparityMap known = without_occluded(pair.left_disparity, pair.left_occluded);
    pictures.push_back({name + ", occluded points white", grey_picture(known.view(), 0, near)});
    add_levels(name, pair, table);
  }
  constexpr int kColumns = 2;
  constexpr double kPictureWidth = 220;
  content.pictures.push_back(
      {"grey", draw_picture_sheet("True disparities of the left image (lighter: nearer)", pictures,
                                  kColumns, kPictureWidth)});
  content.tables.push_back(std::move(table));
  return content;
}

/// How well pixels of equal grey level say which candidate is right.
struct MatchingChance {
  double right_percent = 0;  ///< of the visible pixels, that have the grey level of their partner
  double wrong_percent = 0;  ///< of all other candidates, that have it too
};

MatchingChance chance_of(const BookPair& pair) {
  constexpr float kEqual = 0.5F;  // grey levels
  const int width = pair.left.width();
  std::vector<float> left(static_cast<std::size_t>(width));
  std::vector<float> right(left.size());
  double right_equal = 0;
  double right_all = 0;
  double wrong_equal = 0;
  double wrong_all = 0;
  for (int y = 0; y < pair.left.height(); ++y) {
    intensity_row(pair.left, y, left.data());
    intensity_row(pair.right, y, right.data());
    for (int x = 0; x < width; ++x) {
      for (int d = pair.search.min; d <= pair.search.max; ++d) {
        if (x - d < 0 || x - d >= width || pair.left_occluded.at(x, y) != 0) {
          continue;
        }
        const bool is_right = static_cast<float>(d) == pair.left_disparity.at(x, y);
        const bool is_equal = std::abs(left[static_cast<std::size_t>(x)] -
                                       right[static_cast<std::size_t>(x - d)]) < kEqual;
        (is_right ? right_all : wrong_all) += 1;
        (is_right ? right_equal : wrong_equal) += is_equal ? 1 : 0;
      }
    }
  }
  return {100 * right_equal / right_all, 100 * wrong_equal / wrong_all};
}

FigureContent make_pairs(const FigureRun& run) {
  FigureContent content;
  FigureTable table{"",
                    {"pair", "noise_sigma", "equal_at_true_disparity_percent",
                     "equal_at_other_candidates_percent"}};
  std::vector<SheetPicture> pictures;
  for (const std::string& name : run.settings.pairs) {
    for (const double chosen : run.settings.noise_sigmas) {
      const double noise = noise_in_force(chosen, name);
      const BookPair pair = pair_of(run.settings, name, noise);
      const std::string title =
          noise > 0 ? fmt::format("{}, noise {}", name, noise_label(noise)) : name;
      pictures.push_back({title + ": left", eight_bit(pair.left)});
      pictures.push_back({title + ": right", eight_bit(pair.right)});
      const MatchingChance chance = chance_of(pair);
      table.add(name, noise, fmt::format("{:.2f}", chance.right_percent),
                fmt::format("{:.2f}", chance.wrong_percent));
      if (name.starts_with("rds") && noise == 0) {
        content.comparisons.push_back({name + ": pixels not in correspondence that match", "50 %",
                                       fmt::format("{:.1f} %", chance.wrong_percent)});
      }
    }
  }
  constexpr int kColumns = 4;
  constexpr double kPictureWidth = 200;
  content.pictures.push_back(
      {"", draw_picture_sheet("Synthetic pairs", pictures, kColumns, kPictureWidth)});
  content.tables.push_back(std::move(table));
  content.images =
      "generated; the book's texture 'real' is part of a photograph of grass that is not public, "
      "ours is noise that looks like grass";
  return content;
}

}  // namespace

std::vector<BookFigure> pattern_figures() {
  return {{.key = "6.3",
           .section = "6.2",
           .title = "Disparity pattern of the pairs ramp and rds",
           .book = "A square in front of a background, as a surface, in grey levels and with the "
                   "occluded points in white.",
           .defaults = {.size_px = 100, .pairs = {"rds-square"}, .seed = 1},
           .make = make_pattern},
          {.key = "6.4",
           .section = "6.2",
           .title = "The pairs ramp and rds",
           .book = "Left and right images. ramp is a linear ramp with Gaussian noise, which is "
                   "independent in both images; rds has random dots of two grey levels with equal "
                   "probability and no noise.",
           .defaults = {.size_px = 100,
                        .noise_sigmas = {kBookNoise},
                        .pairs = {"ramp-square", "rds-square"},
                        .seed = 1},
           .make = make_pairs},
          {.key = "6.14",
           .section = "6.6",
           .title = "Disparity pattern bars",
           .book = "Two rectangles at two disparities. The narrow one is displaced by more than "
                   "twice its width, which violates the ordering constraint.",
           .defaults = {.size_px = 100, .pairs = {"rds-bars"}, .seed = 1},
           .make = make_pattern},
          {.key = "6.15",
           .section = "6.6",
           .title = "The five synthetic pairs",
           .book = "ramp/square, rds/square, real/square, rds/bars and real/bars.",
           .defaults = {.size_px = 100,
                        .noise_sigmas = {kBookNoise},
                        .pairs = {kBookPairNames.begin(), kBookPairNames.end()},
                        .seed = 1},
           .make = make_pairs}};
}

}  // namespace vantage
