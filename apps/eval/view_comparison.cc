#include "apps/eval/view_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <variant>

#include "engine/error.h"
#include "engine/evaluation/immersive_psnr.h"
#include "engine/io/video/frame_source.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage::apps {
namespace {

/// Whether a pixel is to be compared.
bool has_white(const Mask& mask) {
  for (int y = 0; y < mask.height(); ++y) {
    if (std::find(mask.row(y), mask.row(y) + mask.width(), 255) != mask.row(y) + mask.width()) {
      return true;
    }
  }
  return false;
}

/// Adds the scores of a frame to the sums in `all`, weighted by its pixels.
void add_scores(const ViewScores& frame, double immersive_psnr_db, ViewComparison& all) {
  const auto pixels = static_cast<double>(frame.pixels);
  all.scores.pixels += frame.pixels;
  all.scores.mean_squared_difference += pixels * frame.mean_squared_difference;
  all.scores.mean_absolute_difference += pixels * frame.mean_absolute_difference;
  all.scores.ssim = all.scores.ssim.value_or(0) + pixels * frame.ssim.value_or(std::nan(""));
  all.immersive_psnr_db += pixels * immersive_psnr_db;
}

void divide_sums(ViewComparison& all) {
  ViewScores& scores = all.scores;
  if (scores.pixels == 0) {
    throw Error("no pixels to compare, expected masks that are not empty");
  }
  const auto pixels = static_cast<double>(scores.pixels);
  scores.mean_squared_difference /= pixels;
  scores.mean_absolute_difference /= pixels;
  scores.psnr_db = psnr_db(scores.mean_squared_difference);
  scores.ssim = scores.ssim.value_or(std::nan("")) / pixels;
  all.immersive_psnr_db /= pixels;
}

}  // namespace

Mask white_pixels(const Photograph& photograph, const std::string& path) {
  const auto* pixels = std::get_if<Image<std::uint8_t>>(&photograph.pixels);
  if (pixels == nullptr) {
    throw Error(fmt::format("{}: not a mask, expected an 8-bit image", path));
  }
  const int colours = std::min(pixels->channels(), 3);
  Mask mask(pixels->width(), pixels->height());
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      const std::uint8_t* pixel = pixels->row(y) + x * pixels->channels();
      const bool is_white = std::all_of(pixel, pixel + colours, [](int v) { return v == 255; });
      mask.at(x, y) = is_white ? 255 : 0;
    }
  }
  return mask;
}

ViewComparison compare_views(const std::string& views, const std::string& truth,
                             const std::string& mask, Execution& execution) {
  PairSourceOptions sources;
  sources.left = views;
  sources.right = truth;
  std::optional<Mask> counted;
  if (!mask.empty()) {
    const std::unique_ptr<FrameSource> masks = open_frame_source(mask);
    Photograph first;
    if (masks->frame_count() > 1) {
      sources.more = {mask};
    } else if (masks->next(first)) {
      counted = white_pixels(first, mask);
    }
  }
  const std::unique_ptr<PairSource> pairs = open_pair_source(sources);
  ViewComparison all;
  for (const std::string& text : pairs->remarks()) {
    all.remarks.push_back({Remark::Kind::kWarning, "pairing",
                           fmt::format("views are left, photographs right: {}", text)});
  }
  all.frames = SettingValue::array();
  FramePair pair;
  while (pairs->fetch(pair)) {
    pairs->decode(pair);
    if (!pair.more.empty()) {
      counted = white_pixels(pair.more.front(), mask);
    }
    const auto chosen = counted ? std::optional(std::as_const(*counted).view()) : std::nullopt;
    all.flicker.add(pair.left, pair.right, chosen);
    SettingValue row = {{"frames", pairs->describe(pair.index)}, {"pixels", 0}};
    if (!counted || has_white(*counted)) {
      const ViewScores scores = evaluate_view(pair.left, pair.right, execution, chosen);
      const double immersive_db = immersive_psnr_db(pair.left, pair.right, chosen);
      add_scores(scores, immersive_db, all);
      row["pixels"] = scores.pixels;
      row["psnr_db"] = scores.psnr_db;
      row["iv_psnr_db"] = immersive_db;
    }
    all.frames.push_back(std::move(row));
  }
  divide_sums(all);
  return all;
}

}  // namespace vantage::apps
