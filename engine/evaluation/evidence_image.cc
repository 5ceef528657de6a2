#include "engine/evaluation/evidence_image.h"

#include <limits>

namespace vantage {

Image<float> evidence_image(const Photograph& left, const Photograph& right,
                            Displacement displacement, const MethodParameters& parameters,
                            Execution& execution) {
  const EvidencePair pair(left, right, parameters, execution);
  Image<float> evidence(pair.width(), pair.height());
  execution.executor().parallel_for(pair.height(), [&](int y) {
    const int partner_y = y - displacement.y_px;
    for (int x = 0; x < pair.width(); ++x) {
      const int partner_x = x - displacement.x_px;
      const bool has_partner =
          partner_x >= 0 && partner_x < pair.width() && partner_y >= 0 && partner_y < pair.height();
      evidence.at(x, y) =
          has_partner
              ? static_cast<float>(pair.evidence(Side::kLeft, {x, x + 1, y, y + 1}, displacement))
              : std::numeric_limits<float>::quiet_NaN();
    }
  });
  return evidence;
}

}  // namespace vantage
