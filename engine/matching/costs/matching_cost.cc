#include "engine/matching/costs/matching_cost.h"

namespace vantage {

CostModel::CostModel(const MethodParameters& parameters)
    : parameters_(parameters),
      measurement_(kernels::ContaminatedGaussian::of(parameters.sigma_measurement,
                                                     parameters.epsilon_measurement)) {}

void CostModel::likelihoods(const CostRow& row, float* cells) const {
  energies(row, cells);
  const kernels::CandidateGeometry& geometry = row.partner.geometry();
  kernels::likelihood_of_costs({row.columns.size(), geometry.lanes(), geometry.count}, measurement_,
                               cells);
}

float CostModel::likelihood_without_partner() const {
  return measurement_.likelihood_without_partner();
}

kernels::KernelWork CostModel::likelihood_work(int channels) const {
  return energy_work(channels) + kernels::kLikelihoodOfCostsWork;
}

}  // namespace vantage
