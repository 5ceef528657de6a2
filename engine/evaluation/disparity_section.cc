#include "engine/evaluation/disparity_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

#include "engine/error.h"

namespace vantage {
namespace {

/// Keeps one row of a volume.
class KeptSection final : public VolumeSink {
 public:
  KeptSection(int y, DisparitySection& section) : y_(y), section_(section) {}

  void start(const VolumeShape& shape) override {
    section_.disparities = shape.disparities;
    section_.steps_per_px = shape.steps_per_px;
    section_.content = shape.content;
    section_.values.resize(shape.width_px, shape.candidates());
  }
  void write(int x, int y, int columns, const float* values) override {
    if (y != y_) {
      return;
    }
    const int candidates = section_.values.height();
    for (int j = 0; j < columns; ++j) {
      for (int i = 0; i < candidates; ++i) {
        section_.values.at(x + j, i) = *values++;
      }
    }
  }

 private:
  int y_;
  DisparitySection& section_;
};

}  // namespace

DisparitySection disparity_section(const StereoMatcher& matcher, const Photograph& left,
                                   const Photograph& right, Side reference, VolumeKind kind,
                                   int y) {
  if (y < 0 || y >= left.height()) {
    throw UsageError(fmt::format("y is {}, expected a row from 0 to {}", y, left.height() - 1));
  }
  if (matcher.in_force().disparities_y) {
    throw UsageError("there are displacements in a section, expected a search along rows only");
  }
  DisparitySection section;
  KeptSection sink(y, section);
  const VolumeRequest request{.side = reference, .kind = kind, .sink = &sink};
  const bool is_left = reference == Side::kLeft;
  DisparityMaps maps;
  matcher.match(left, right,
                {.left = is_left, .right = !is_left, .unmatched = false, .volumes = {&request, 1}},
                maps);
  return section;
}

float section_quantile(const DisparitySection& section, double share) {
  std::vector<float> known;
  for (int i = 0; i < section.values.height(); ++i) {
    std::copy_if(section.values.row(i), section.values.row(i) + section.values.width(),
                 std::back_inserter(known), [](float value) { return !std::isnan(value); });
  }
  if (known.empty()) {
    return 0;
  }
  const auto place =
      known.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(known.size() - 1));
  std::nth_element(known.begin(), place, known.end());
  return *place;
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
