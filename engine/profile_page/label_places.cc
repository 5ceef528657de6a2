#include "engine/profile_page/label_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vantage {
namespace {

constexpr double kGap = 3;
constexpr double kStep = 7;
constexpr int kRings = 14;
constexpr int kDirections = 16;

double overlap(double begin_a, double end_a, double begin_b, double end_b) {
  return std::max(0.0, std::min(end_a, end_b) - std::max(begin_a, begin_b));
}

double covered_area(const LabelPlace& a, const LabelPlace& b) {
  return overlap(a.corner.x, a.corner.x + a.width, b.corner.x, b.corner.x + b.width) *
         overlap(a.corner.y, a.corner.y + a.height, b.corner.y, b.corner.y + b.height);
}

LabelPlace box_around(const LabelledDisc& disc) {
  return {
      {disc.centre.x - disc.radius, disc.centre.y - disc.radius}, 2 * disc.radius, 2 * disc.radius};
}

bool is_within(const LabelPlace& place, const ChartArea& area) {
  return place.corner.x >= area.corner.x && place.corner.y >= area.corner.y &&
         place.corner.x + place.width <= area.corner.x + area.width &&
         place.corner.y + place.height <= area.corner.y + area.height;
}

/// The box of the label whose nearest point to the disc lies `distance` away in a direction; to the
/// right first, then up and down in turn.
LabelPlace candidate(const LabelledDisc& disc, int direction, double distance) {
  const int turn = direction % 2 == 0 ? -direction / 2 : (direction + 1) / 2;
  const double angle = turn * 2 * std::numbers::pi / kDirections;
  LabelPlace place;
  place.width = text_width(disc.label, kTextSize);
  place.height = 1.25 * kTextSize;
  const double reach = disc.radius + distance;
  // The label's centre goes round on a box with room for half the label on every side.
  place.corner.x = disc.centre.x + std::cos(angle) * (reach + place.width / 2) - place.width / 2;
  place.corner.y = disc.centre.y + std::sin(angle) * (reach + place.height / 2) - place.height / 2;
  return place;
}

}  // namespace

std::vector<LabelPlace> place_labels(const std::vector<LabelledDisc>& discs,
                                     const ChartArea& area) {
  std::vector<LabelPlace> taken;
  taken.reserve(2 * discs.size());
  for (const LabelledDisc& disc : discs) {
    taken.push_back(box_around(disc));
  }
  std::vector<LabelPlace> result;
  for (const LabelledDisc& disc : discs) {
    LabelPlace best;
    double least = disc.label.empty() ? 0 : std::numeric_limits<double>::infinity();
    for (int ring = 0; ring < kRings && least > 0; ++ring) {
      for (int direction = 0; direction < kDirections && least > 0; ++direction) {
        LabelPlace place = candidate(disc, direction, kGap + ring * kStep);
        place.is_far = ring > 1;
        double covered = is_within(place, area) ? 0 : place.width * place.height;
        for (const LabelPlace& other : taken) {
          covered += covered_area(place, other);
        }
        if (covered < least) {
          least = covered;
          best = place;
        }
      }
    }
    taken.push_back(best);
    result.push_back(best);
  }
  return result;
}

}  // namespace vantage
