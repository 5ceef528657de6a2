#include <algorithm>
#include <numbers>
#include <optional>

#include "engine/matching/costs/cost_table.h"
#include "engine/matching/costs/gradient_planes.h"
#include "kernels/evidence/evidence.h"

namespace vantage {
namespace {

class GradientModel final : public CostModel {
 public:
  using CostModel::CostModel;

  void energies(const CostRow& row, float* cells) const override {
    kernels::negated_evidence_row(row.pairs(&GradientPlanes::gradients),
                                  evidence_norm(parameters()), cells);
  }
  /// (1−ε) exp((E − max over the column)/σ) + ε, for cells with a partner.
  void likelihoods(const CostRow& row, float* cells) const override {
    energies(row, cells);
    const auto convert = [&](const kernels::EvidenceRow& evidence, float* of_columns) {
      kernels::likelihood_of_evidence(
          evidence,
          static_cast<float>(std::max(kernels::kMinEvidenceSigma, parameters().sigma_measurement)),
          measurement().epsilon, of_columns);
    };
    const kernels::CandidateGeometry& geometry = row.partner.geometry();
    if (!row.partner.is_gathered()) {
      convert({geometry, row.columns.begin, row.columns.size()}, cells);
      return;
    }
    for (int x = row.columns.begin; x < row.columns.end; ++x, cells += geometry.lanes()) {
      // A geometry whose column end − 1 has just these candidates.
      const auto [begin, end] = row.partner.with_partner(x, row.y);
      convert({{.width = end - begin, .disparity_min = 0, .count = geometry.count}, end - 1, 1},
              cells);
    }
  }
  [[nodiscard]] std::optional<float> energy_without_partner() const override { return 0.0F; }
  [[nodiscard]] CostBounds energy_bounds() const override {
    // The octagon norm is at most (1.4142 + 0.0396 · 1.4142) times the larger component, L1 twice.
    const double ratio =
        evidence_norm(parameters()) == kernels::EvidenceNorm::kL1 ? 2 : 1.04 * std::numbers::sqrt2;
    const double longest = ratio * largest_gradient();
    return {static_cast<float>(-longest), static_cast<float>(2 * parameters().alpha * longest)};
  }
  [[nodiscard]] kernels::KernelWork energy_work(int channels) const override {
    return kernels::negated_evidence_work(evidence_norm(parameters()), channels);
  }
  [[nodiscard]] kernels::KernelWork likelihood_work(int channels) const override {
    return energy_work(channels) + kernels::kLikelihoodOfEvidenceWork;
  }

 private:
  /// Maximum response of the filter along one axis (EQUATIONS §2), with margin for rounding.
  [[nodiscard]] double largest_gradient() const {
    switch (parameters().gradient) {
      case GradientFilter::kCentral:
      case GradientFilter::kForward:
        return kWhite;
      case GradientFilter::kSobel:
        return 4 * kWhite;
      case GradientFilter::kSimoncelli3:
        return 0.4554 * kWhite;
      case GradientFilter::kSimoncelli5:
        return (0.1077 + 0.2828) * kWhite;
    }
    return 0;
  }
};

}  // namespace

kernels::EvidenceNorm evidence_norm(const MethodParameters& parameters) {
  if (parameters.gradient_components == GradientComponents::kX) {
    return kernels::EvidenceNorm::kAcross;
  }
  switch (parameters.norm) {
    case GradientNorm::kOctagon:
      return kernels::EvidenceNorm::kOctagon;
    case GradientNorm::kL1:
      return kernels::EvidenceNorm::kL1;
    case GradientNorm::kMax:
      return kernels::EvidenceNorm::kMax;
    case GradientNorm::kL2:
      break;
  }
  return kernels::EvidenceNorm::kL2;
}

void GradientPlanes::prepare(const PlaneSource& source, const MethodParameters& parameters) {
  const int width = source.width();
  const int height = source.height();
  prepare_filter_intensities(source, intensities_);
  source.for_each_channel([&](std::size_t c) {
    for (FeaturePlane<float>& plane : gradients[c]) {
      plane.resize(source);
    }
    if (parameters.prefilter) {
      smooth_intensities_[c].resize(width, height, kFilterMarginBefore, kFilterMarginAfter);
      smooth_intensities({intensities_[c], width, height}, source.execution,
                         smooth_intensities_[c]);
    }
  });
  const auto alpha = static_cast<float>(parameters.alpha);
  const FilterIntensities& intensities = parameters.prefilter ? smooth_intensities_ : intensities_;
  source.for_each_channel_row([&](std::size_t c, int y) {
    const auto work = source.execution.scratch().lease(sizeof(float) * filter_work_floats(width));
    auto& [gx, gy, half_norm] = gradients[c];
    gradient_row({intensities[c], width, height}, y, parameters.gradient,
                 reinterpret_cast<float*>(work.data()), gx.plain.row(y), gy.plain.row(y));
    kernels::evidence_planes_row({gx.plain.row(y), gy.plain.row(y), half_norm.plain.row(y), width},
                                 alpha, evidence_norm(parameters));
    for (FeaturePlane<float>& plane : gradients[c]) {
      plane.finish_row(source, y);
    }
  });
}

MatchingCost gradient_cost() {
  return {.key = MatchCost::kGradient,
          .name = "gradient",
          .description = "difference of gradients less their mean length",
          .options = {"alpha", "gradient-components", "norm", "gradient", "prefilter"},
          .is_evidence = true,
          .jump_limit = 20,
          .occlusion_penalty = 2,
          .make_planes = make_planes_as<GradientPlanes>,
          .make_model = make_model_as<GradientModel>};
}

}  // namespace vantage
