#include "engine/matching/estimation/evidence_pair.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/error.h"
#include "engine/matching/costs/gradient_planes.h"

namespace vantage {
namespace {

// Block size up to which evidence_sum() adds in float.
constexpr int kBlockColumns = 256;
constexpr int kBlockRows = 16;

kernels::GradientBlock gradients_at(const CostImage& image, int x, int y) {
  const auto& [gx, gy, half_norm] = static_cast<const GradientPlanes&>(image.planes()).gradients[0];
  const auto row_stride = image.height() > 1 ? gx.plain.row(1) - gx.plain.row(0) : 0;
  return {gx.plain.row(y) + x, gy.plain.row(y) + x, half_norm.plain.row(y) + x, row_stride};
}

}  // namespace

EvidencePair::EvidencePair(const Photograph& left, const Photograph& right,
                           MethodParameters parameters, Execution& execution)
    : width_(left.width()), height_(left.height()), norm_(evidence_norm(parameters)) {
  if (left.width() != right.width() || left.height() != right.height()) {
    throw Error(fmt::format("left image is {}x{} but right image is {}x{}, expected equal sizes",
                            left.width(), left.height(), right.width(), right.height()));
  }
  parameters.cost = MatchCost::kGradient;
  parameters.aggregation = Aggregation::kNone;
  parameters.colour = ColourUse::kLuma;
  validate(parameters);
  const kernels::CandidateGeometry geometry{width_, 0, 1, -1};
  const CostImageUse use{true, false, false};
  left_.prepare(left, parameters, geometry, use, execution);
  right_.prepare(right, parameters, geometry, use, execution);
}

double EvidencePair::evidence(Side reference, const PixelBlock& block,
                              Displacement displacement) const {
  return reference == Side::kLeft
             ? sum(left_, right_, block, -displacement.x_px, -displacement.y_px)
             : sum(right_, left_, block, displacement.x_px, displacement.y_px);
}

double EvidencePair::contrast(Side reference, const PixelBlock& block) const {
  const CostImage& image = reference == Side::kLeft ? left_ : right_;
  return sum(image, image, block, 0, 0);
}

double EvidencePair::sum(const CostImage& reference, const CostImage& partner,
                         const PixelBlock& block, int partner_dx, int partner_dy) const {
  const int x_begin = std::max(block.x_begin, -partner_dx);
  const int x_end = std::min(block.x_end, width_ - partner_dx);
  const int y_begin = std::max(block.y_begin, -partner_dy);
  const int y_end = std::min(block.y_end, height_ - partner_dy);
  double total = 0;
  for (int y = y_begin; y < y_end; y += kBlockRows) {
    for (int x = x_begin; x < x_end; x += kBlockColumns) {
      total +=
          kernels::evidence_sum({.reference = gradients_at(reference, x, y),
                                 .partner = gradients_at(partner, x + partner_dx, y + partner_dy),
                                 .columns = std::min(kBlockColumns, x_end - x),
                                 .rows = std::min(kBlockRows, y_end - y),
                                 .norm = norm_});
    }
  }
  return total;
}

}  // namespace vantage
