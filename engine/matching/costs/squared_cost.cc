#include "engine/matching/costs/cost_table.h"
#include "engine/matching/costs/grey_planes.h"

namespace vantage {
namespace {

class SquaredModel final : public CostModel {
 public:
  using CostModel::CostModel;

  void energies(const CostRow& row, float* cells) const override {
    kernels::squared_row(row.pairs(&GreyPlanes::grey), cells);
  }
  /// The mean of the channels' squares is the squared residual.
  void likelihoods(const CostRow& row, float* cells) const override {
    kernels::contaminated_likelihood_row(row.pairs(&GreyPlanes::grey), measurement(), cells);
  }
  [[nodiscard]] CostBounds energy_bounds() const override {
    return {0, static_cast<float>(kWhite * kWhite)};
  }
  [[nodiscard]] kernels::KernelWork energy_work(int channels) const override {
    return kernels::squared_work(channels);
  }
  [[nodiscard]] kernels::KernelWork likelihood_work(int channels) const override {
    return kernels::contaminated_likelihood_work(channels);
  }
};

}  // namespace

MatchingCost squared_cost() {
  // Squares of large differences would let single pixels dominate all around them.
  constexpr float kContrastIntensity = 20;
  return {.key = MatchCost::kSquared,
          .name = "squared",
          .description = "squared difference of grey levels",
          .options = {},
          .has_column_sums = true,
          .max_contrast = kContrastIntensity * kContrastIntensity,
          .jump_limit = 200,
          .occlusion_penalty = 100,
          .make_planes = make_planes_as<GreyPlanes>,
          .make_model = make_model_as<SquaredModel>};
}

}  // namespace vantage
