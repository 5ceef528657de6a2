#include "engine/evaluation/disparity_section.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

#include "engine/order_statistics.h"

namespace vantage {
float section_quantile(const DisparitySection& section, double share) {
  std::vector<float> known;
  for (int i = 0; i < section.values.height(); ++i) {
    std::copy_if(section.values.row(i), section.values.row(i) + section.values.width(),
                 std::back_inserter(known), [](float value) { return !std::isnan(value); });
  }
  if (known.empty()) {
    return 0;
  }
  return value_of_rank(known,
                       static_cast<std::size_t>(share * static_cast<double>(known.size() - 1)));
}

Image<std::uint8_t> section_picture(const DisparitySection& section, float dark, float light) {
  constexpr float kWhite = 255;
  const int candidates = section.values.height();
  Image<std::uint8_t> picture(section.values.width(), candidates);
  for (int i = 0; i < candidates; ++i) {
    std::transform(
        section.values.row(i), section.values.row(i) + section.values.width(),
        picture.row(candidates - 1 - i), [&](float value) {
          const float level =
              std::isnan(value) ? 1 : std::clamp((value - dark) / (light - dark), 0.0F, 1.0F);
          return static_cast<std::uint8_t>(std::lround(level * kWhite));
        });
  }
  return picture;
}

}  // namespace vantage
