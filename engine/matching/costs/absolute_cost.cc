#include <algorithm>
#include <limits>

#include "engine/matching/costs/cost_table.h"
#include "engine/matching/costs/grey_planes.h"

namespace vantage {
namespace {

class AbsoluteModel : public CostModel {
 public:
  using CostModel::CostModel;

  void energies(const CostRow& row, float* cells) const override {
    kernels::absolute_row(row.pairs(&GreyPlanes::grey), std::numeric_limits<float>::infinity(),
                          cells);
  }
  [[nodiscard]] CostBounds energy_bounds() const override { return {0, kWhite}; }
  [[nodiscard]] kernels::KernelWork energy_work(int channels) const override {
    return kernels::absolute_work(channels);
  }
};

class TruncatedModel final : public AbsoluteModel {
 public:
  using AbsoluteModel::AbsoluteModel;

  void energies(const CostRow& row, float* cells) const override {
    kernels::absolute_row(row.pairs(&GreyPlanes::grey), static_cast<float>(parameters().truncation),
                          cells);
  }
  [[nodiscard]] CostBounds energy_bounds() const override {
    return {0, static_cast<float>(std::min(kWhite, parameters().truncation))};
  }
};

}  // namespace

MatchingCost absolute_cost() {
  return {.key = MatchCost::kAbsolute,
          .name = "absolute",
          .description = "absolute difference of grey levels",
          .options = {},
          .jump_limit = 10,
          .occlusion_penalty = 8,
          .make_planes = make_planes_as<GreyPlanes>,
          .make_model = make_model_as<AbsoluteModel>};
}

MatchingCost truncated_cost() {
  return {.key = MatchCost::kTruncated,
          .name = "truncated",
          .description = "absolute difference, at most the truncation",
          .options = {"truncation"},
          .jump_limit = 10,
          .occlusion_penalty = 8,
          .make_planes = make_planes_as<GreyPlanes>,
          .make_model = make_model_as<TruncatedModel>};
}

}  // namespace vantage
