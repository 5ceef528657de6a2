#include "engine/matching/costs/stage_ray_census_energy.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>

#include "engine/column_work.h"
#include "engine/matching/costs/partner_rows.h"
#include "engine/matching/costs/ray_census_planes.h"
#include "engine/matching/costs/ray_census_tables.h"
#include "kernels/ray_census/ray_census.h"

namespace vantage {
namespace {

class RayCensusEnergyStage final : public scheduler::RowStage {
 public:
  RayCensusEnergyStage(const MethodParameters& parameters,
                       const kernels::CandidateGeometry& geometry, const CostImage& reference,
                       const CostPartner& partner, int height)
      : RowStage({geometry.width, height}),
        thresholds_(parameters.census_thresholds),
        energies_(ray_census_energies(parameters)),
        partner_(reference, partner, geometry),
        lanes_(geometry.lanes()),
        count_(geometry.count) {}

  [[nodiscard]] std::string_view name() const override { return "cost"; }
  [[nodiscard]] std::size_t bytes_per_column() const override {
    return static_cast<std::size_t>(lanes_);
  }
  [[nodiscard]] scheduler::ColumnWork column_work() const override {
    return vantage::column_work(kernels::ray_census_energy_work(thresholds_), count_);
  }

  void make_row(const scheduler::RowTask& task) const override {
    auto* const cells = reinterpret_cast<std::uint8_t*>(task.output);
    if (!partner_.has_row(task.y)) {
      for (int x = task.columns.begin; x < task.columns.end; ++x) {
        std::uint8_t* const column = column_at(x, task, cells);
        std::fill(column, column + count_, energies_.without_partner);
        std::fill(column + count_, column + lanes_, std::numeric_limits<std::uint8_t>::max());
      }
      return;
    }
    kernels::ray_census_energy_row(ray_codes(partner_, task.y, task.columns, nullptr, thresholds_),
                                   energies_.by_distance, cells);
    const kernels::CandidateRange inner = partner_.columns_with_all_partners();
    close_columns({task.columns.begin, std::min(inner.begin, task.columns.end)}, task, cells);
    close_columns({std::max({inner.begin, inner.end, task.columns.begin}), task.columns.end}, task,
                  cells);
  }

 private:
  /// Energies of candidates without a partner.
  void close_columns(scheduler::Range columns, const scheduler::RowTask& task,
                     std::uint8_t* cells) const {
    for (int x = columns.begin; x < columns.end; ++x) {
      const kernels::CandidateRange inside = partner_.with_partner(x, task.y);
      std::uint8_t* const column = column_at(x, task, cells);
      std::fill(column, column + inside.begin, energies_.without_partner);
      std::fill(column + std::max(inside.begin, inside.end), column + count_,
                energies_.without_partner);
    }
  }
  [[nodiscard]] std::uint8_t* column_at(int x, const scheduler::RowTask& task,
                                        std::uint8_t* cells) const {
    return cells + static_cast<std::ptrdiff_t>(x - task.columns.begin) * lanes_;
  }

  int thresholds_;
  RayCensusEnergies energies_;
  PartnerRows partner_;
  int lanes_;
  int count_;
};

}  // namespace

std::unique_ptr<scheduler::RowStage> make_ray_census_energy_stage(
    const MethodParameters& parameters, const kernels::CandidateGeometry& geometry,
    const CostImage& reference, const CostPartner& partner, int height) {
  return std::make_unique<RayCensusEnergyStage>(parameters, geometry, reference, partner, height);
}

}  // namespace vantage
