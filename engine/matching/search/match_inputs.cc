#include "engine/matching/search/match_inputs.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/error.h"
#include "kernels/partner_choice/partner_choice.h"

namespace vantage {

void require_equal_sizes(const Photograph& first, std::string_view first_name,
                         const Photograph& second, std::string_view second_name) {
  if (first.width() != second.width() || first.height() != second.height()) {
    throw Error(fmt::format("{} is {}x{} but {} is {}x{}, expected equal sizes", first_name,
                            first.width(), first.height(), second_name, second.width(),
                            second.height()));
  }
}

void require_different_baselines(std::span<const OtherView> others) {
  if (others.empty()) {
    throw UsageError("there is no image beside the reference, expected at least one");
  }
  if (others.size() > kernels::kMaxPartners) {
    throw UsageError(fmt::format("there are {} images beside the reference, expected at most {}",
                                 others.size(), kernels::kMaxPartners));
  }
  for (std::size_t i = 0; i < others.size(); ++i) {
    const double baseline = others[i].baseline;
    if (!(std::isfinite(baseline) && baseline != 0)) {
      throw UsageError(
          fmt::format("baseline {} is {}, expected a finite number other than 0", i + 1, baseline));
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (baseline == others[j].baseline) {
        throw UsageError(fmt::format("baselines {} and {} are both {}, expected different ones",
                                     j + 1, i + 1, baseline));
      }
    }
  }
}

void require_usable(const DisparityPrior& prior, const Photograph& image) {
  constexpr double kMaxWeight = 100;
  if (!(prior.weight >= 0 && prior.weight <= kMaxWeight)) {
    throw UsageError(fmt::format("the weight of the prior is {}, expected a number from 0 to {}",
                                 prior.weight, kMaxWeight));
  }
  for (const ImageView<const float>& map : {prior.left_px, prior.right_px}) {
    if (!map.empty() && (map.width() != image.width() || map.height() != image.height())) {
      throw Error(fmt::format("the prior is {}x{}, expected {}x{} as the images", map.width(),
                              map.height(), image.width(), image.height()));
    }
  }
}

}  // namespace vantage
