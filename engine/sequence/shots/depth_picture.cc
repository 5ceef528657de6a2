#include "engine/sequence/shots/depth_picture.h"

#include <algorithm>
#include <cmath>

#include "engine/sequence/shots/preview_range.h"

namespace vantage {
namespace {

constexpr float kLevels = 65534;  // above the first one that is known

}  // namespace

DisparityRange searched_in_all(DisparityRange film, const ShotTable* shots) {
  if (shots == nullptr) {
    return film;
  }
  DisparityRange all = shots->shots.front().search.value_or(film);
  for (const Shot& shot : shots->shots) {
    const DisparityRange one = shot.search.value_or(film);
    all = {std::min(all.min, one.min), std::max(all.max, one.max)};
  }
  return all;
}

PreviewRange depth_range_of(const DepthVideoScale& scale, DisparityRange film,
                            const ShotTable* shots, int frame) {
  if (scale.scope == DepthVideoScale::Scope::kGiven) {
    return scale.given;
  }
  const bool of_shot = scale.scope == DepthVideoScale::Scope::kShot && shots != nullptr;
  const DisparityRange range =
      of_shot ? shots->shot_of(frame).search.value_or(film) : searched_in_all(film, shots);
  return {static_cast<float>(range.min),
          static_cast<float>(range.max > range.min ? range.max : range.min + 1)};
}

PreviewRange preview_range_of_frame(const SequenceOptions& options, const ShotTable* shots,
                                    int frame, const std::optional<DisparityRange>& of_pair) {
  if (options.preview_range_per_shot) {
    return shots->shot_of(frame).preview_range;
  }
  return preview_range_of(of_pair.value_or(searched_in_all(options.match.disparities, shots)));
}

void paint_depth(ImageView<const float> map_px, PreviewRange range, Image<std::uint16_t>& picture) {
  if (picture.width() != map_px.width() || picture.height() != map_px.height() ||
      picture.channels() != 1) {
    picture = Image<std::uint16_t>(map_px.width(), map_px.height());
  }
  const float span = range.max_px - range.min_px;
  for (int y = 0; y < map_px.height(); ++y) {
    const float* disparities = map_px.row(y);
    std::uint16_t* levels = picture.row(y);
    for (int x = 0; x < map_px.width(); ++x) {
      const float d = disparities[x];
      const float share = std::clamp((d - range.min_px) / span, 0.0F, 1.0F);
      levels[x] = std::isfinite(d)
                      ? static_cast<std::uint16_t>(1 + static_cast<int>(share * kLevels + 0.5F))
                      : std::uint16_t{0};
    }
  }
}

}  // namespace vantage
