#include "python/matched_images.h"

#include <fmt/format.h>

#include <utility>

#include "engine/io/images/black_border.h"
#include "engine/io/images/scene_mask.h"

namespace vantage::python {
namespace {

Photograph borrowed(const Photograph& photograph) {
  return std::visit(
      [&](const auto& image) {
        return Photograph{std::remove_cvref_t<decltype(image)>::borrowed(image.view()),
                          photograph.origin, Mask::borrowed(photograph.left_out.view())};
      },
      photograph.pixels);
}

}  // namespace

MatchedImages::MatchedImages(std::vector<PixelArray> arrays, std::vector<double> baselines,
                             std::array<Mask, 2> masks, bool finds_borders,
                             std::optional<double> white_level)
    : arrays_(std::move(arrays)),
      baselines_(std::move(baselines)),
      masks_(std::move(masks)),
      finds_borders_(finds_borders),
      white_level_given_(white_level) {
  const std::size_t others = arrays_.size() - 1;
  if ((!baselines_.empty() || others > 1) && baselines_.size() != others) {
    throw UsageError(
        fmt::format("baselines has {} number{}, expected {}: one for each image but "
                    "the first",
                    baselines_.size(), baselines_.size() == 1 ? "" : "s", others));
  }
}

MatchedImages::MatchedImages(Photograph left, Photograph right) {
  own_.push_back(std::move(left));
  own_.push_back(std::move(right));
}

std::vector<Photograph> MatchedImages::photographs() const {
  std::vector<Photograph> photographs;
  for (const PixelArray& array : arrays_) {
    photographs.push_back(array.photograph(white_level_));
  }
  for (const Photograph& photograph : own_) {
    photographs.push_back(borrowed(photograph));
  }
  std::array<Mask, 2> masks = {masks_[0].copy(), masks_[1].copy()};
  if (finds_borders_) {
    masks = {black_border(photographs[0]), black_border(photographs[1])};
  }
  if (!masks[0].empty() || !masks[1].empty()) {  // whose pixels get other values
    for (const std::size_t i : {0, 1}) {
      photographs[i] = arrays_[i].copy();
      white_level_.apply(photographs[i]);
    }
    leave_out_of_pair({}, std::move(masks), photographs[0], photographs[1]);
  }
  return photographs;
}

std::vector<Photograph> MatchedImages::read() {
  std::vector<Photograph> found = photographs();
  for (std::size_t i = 1; i < arrays_.size(); ++i) {
    if (found[i].width() != found[0].width() || found[i].height() != found[0].height()) {
      throw Error(fmt::format("{} is {}x{} but {} is {}x{}, expected equal sizes",
                              arrays_[i].name(), found[i].width(), found[i].height(),
                              arrays_[0].name(), found[0].width(), found[0].height()));
    }
  }
  checksums_ = checksums();
  if (arrays_.empty()) {
    return found;
  }
  WhiteLevelSearch search(white_level_given_);
  for (const Photograph& photograph : found) {
    search.add(photograph);
  }
  white_level_ = search.found();
  return photographs();
}

std::vector<Photograph> MatchedImages::read_again(const char* asked_for) const {
  if (checksums() != checksums_) {
    throw Error(fmt::format(
        "the images have changed since compute(), expected the same for {0}; compute(left, "
        "right, {0}=True) computes it at once",
        asked_for));
  }
  return photographs();
}

std::vector<std::uint32_t> MatchedImages::checksums() const {
  std::vector<std::uint32_t> checksums;
  for (const PixelArray& array : arrays_) {
    checksums.push_back(array.checksum());
  }
  return checksums;
}

MatchOptions MatchedImages::match(const PairMatcher& matcher,
                                  const std::vector<Photograph>& photographs,
                                  const MatchRequest& request, DisparityMaps& maps,
                                  MatchReport* report) const {
  if (is_pair()) {
    return matcher.match(photographs[0], photographs[1], request, maps, report);
  }
  std::vector<OtherView> others;
  for (std::size_t i = 1; i < photographs.size(); ++i) {
    others.push_back({&photographs[i], baselines_[i - 1]});
  }
  return matcher.match_several(photographs[0], others, request, maps, report);
}

}  // namespace vantage::python
