#include "engine/examination/pair_examination.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "engine/error.h"
#include "engine/image/content_hash.h"
#include "engine/image/side.h"
#include "engine/matching/pair_matcher.h"
#include "engine/rectification/rows/row_correction.h"
#include "engine/seconds_since.h"

namespace vantage {
namespace {

/// With more of it in an image there is nothing to match.
constexpr double kMaxTexturelessShare = 0.98;
/// Larger pairs are tried at this size. Work is proportional to pixels and disparities.
constexpr double kMaxTrialPixels = 4e6;
/// With fewer pixels matched a map is mostly fill.
constexpr double kMinMatchedShare = 0.25;

void try_match(const Photograph& left, const Photograph& right, MatchOptions options,
               Execution& execution, PairExamination& examination) {
  options.scale = std::min(1.0, std::sqrt(kMaxTrialPixels / left.width() / left.height()));
  const auto start = std::chrono::steady_clock::now();
  DisparityMaps maps;
  MatchReport report;
  const MatchOptions used = PairMatcher(options, execution, RowMode::kAsIs)
                                .match(left, right, {.left = true}, maps, &report);
  examination.seconds = seconds_since(start) / std::pow(options.scale, 3);
  examination.disparities = used.disparities;
  examination.remarks = std::move(report.remarks);
  examination.shares = report.shares.value();
  examination.noise = options.scale < 1
                          ? find_noise(std::array{&left, &right}, used.disparities, execution)
                          : report.noise;  // that of images as they are
}

void examine_images(const Photograph& left, const Photograph& right, PairExamination& examination) {
  const FoundNoise& noise = examination.noise;
  const double noise_grey = noise.kind == NoiseKind::kSensor ? noise.grey_levels : 0;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const bool is_left = side == Side::kLeft;
    ImageStatistics& image = examination.images[index_of(side)];
    image = image_statistics(is_left ? left : right, noise_grey);
    if (image.textureless_share > kMaxTexturelessShare) {
      examination.problems.push_back(fmt::format("{:.1f} % of the {} image have no texture",
                                                 100 * image.textureless_share,
                                                 is_left ? "left" : "right"));
    }
  }
}

}  // namespace

PairExamination examine_pair(const Photograph& left, const Photograph& right,
                             const MatchOptions& options, Execution& execution) {
  PairExamination examination;
  examination.rows = check_rows(left, right, &execution);
  Photograph corrected;
  if (examination.rows.pays()) {
    correct_rows(right, examination.rows.rows->field, corrected, execution);
  }
  std::string failure;
  try {
    try_match(left, examination.rows.pays() ? corrected : right, options, execution, examination);
  } catch (const Error& error) {
    failure = error.what();
  }
  if (have_same_pixels(left, right)) {
    std::erase_if(examination.remarks,
                  [](const Remark& remark) { return remark.subject == "images"; });
    examination.problems.emplace_back("left and right are the same picture");
  }
  examine_images(left, right, examination);
  if (!failure.empty()) {
    examination.problems.push_back(failure);
  } else if (examination.shares.matched < kMinMatchedShare) {
    examination.problems.push_back(
        fmt::format("only {:.0f} % of the pixels can be matched, expected at least {:.0f} %",
                    100 * examination.shares.matched, 100 * kMinMatchedShare));
  }
  return examination;
}

}  // namespace vantage
