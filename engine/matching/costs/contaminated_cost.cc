#include <cmath>
#include <optional>

#include "engine/matching/costs/cost_table.h"
#include "engine/matching/costs/grey_planes.h"

namespace vantage {
namespace {

class ContaminatedModel final : public CostModel {
 public:
  using CostModel::CostModel;

  void energies(const CostRow& row, float* cells) const override {
    kernels::contaminated_energy_row(row.pairs(&GreyPlanes::grey), measurement(), cells);
  }
  /// With several channels: the exponential of the mean energy.
  void likelihoods(const CostRow& row, float* cells) const override {
    const kernels::GreyPairs intensities = row.pairs(&GreyPlanes::grey);
    if (intensities.channels == 1) {
      kernels::contaminated_likelihood_row(intensities, measurement(), cells);
    } else {
      kernels::contaminated_energy_row(intensities, measurement(), cells);
      kernels::likelihood_of_energies({intensities.columns, intensities.lanes, intensities.count},
                                      cells);
    }
  }
  [[nodiscard]] std::optional<float> energy_without_partner() const override {
    return measurement().energy_without_partner();
  }
  [[nodiscard]] CostBounds energy_bounds() const override {
    return {0, static_cast<float>(-std::log(parameters().epsilon_measurement))};
  }
  [[nodiscard]] kernels::KernelWork energy_work(int channels) const override {
    return kernels::contaminated_energy_work(channels);
  }
  [[nodiscard]] kernels::KernelWork likelihood_work(int channels) const override {
    return channels == 1 ? kernels::contaminated_likelihood_work(channels)
                         : energy_work(channels) + kernels::kLikelihoodOfEnergiesWork;
  }
};

}  // namespace

MatchingCost contaminated_cost() {
  return {.key = MatchCost::kContaminated,
          .name = "contaminated",
          .description = "log-likelihood, Gaussian noise with outliers",
          .options = {"sigma-measurement", "epsilon-measurement"},
          .jump_limit = 1.5,
          .occlusion_penalty = 1,
          .make_planes = make_planes_as<GreyPlanes>,
          .make_model = make_model_as<ContaminatedModel>};
}

}  // namespace vantage
