// Bytes of energies against the logarithms of the likelihoods that the same costs give.
#include "engine/matching/costs/stage_ray_census_energy.h"

#include "engine/matching/costs/ray_census_tables.h"
#include "engine/matching/costs/stage_cost.h"
#include "scheduler/whole_image_pipeline.h"
#include "tests/engine/cell_stages.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/oracle_comparison.h"

namespace vantage::stage_ray_census_energy_test {

using kernels::CandidateGeometry;
using scheduler::Extent;

struct Shape {
  Extent extent;
  DisparityRange range;
  int disparity_y_px = 0;
};
constexpr Shape kShapes[] = {{{1, 1}, {0, 0}},
                             {{1, 7}, {-2, 2}},
                             {{13, 11}, {0, 39}},
                             {{37, 29}, {-4, 12}, 3},
                             {{53, 7}, {0, 63}, -9}};

TEST(RayCensusEnergyStage, IsTheLogarithmOfTheLikelihoods) {
  for (const Shape& shape : kShapes) {
    for (const double epsilon : {0.9, 0.1, 1e-6, 1e-20}) {
      for (const int direction : {-1, 1}) {
        MethodParameters parameters = book_parameters(MatchMethod::kBayes);
        parameters.cost = MatchCost::kRayCensus;
        parameters.census_thresholds = direction < 0 ? 3 : 1;
        parameters.sigma_measurement = 4.8;
        parameters.epsilon_measurement = epsilon;
        const Extent extent = shape.extent;
        const auto pair =
            textured_pair(extent.columns, extent.rows, shape.range, PixelKind::kGrey8, 3);
        const CandidateGeometry geometry{extent.columns, shape.range.min, shape.range.count(),
                                         direction};
        CostImage reference;
        CostImage other;
        reference.prepare(pair.left, parameters, geometry, {true, false, false}, execution());
        other.prepare(pair.right, parameters, geometry, {false, true, true}, execution());
        const CostPartner partner{.image = &other, .disparity_y_px = shape.disparity_y_px};

        CellVolume<float> likelihoods(extent, geometry.lanes());
        const auto costs = make_cost_stage(parameters, geometry, reference, {&partner, 1},
                                           CellMeaning::kLikelihood, extent.rows);
        const CellSink<float> likelihood_sink(likelihoods);
        const std::vector<const scheduler::RowStage*> first = {costs.get(), &likelihood_sink};
        scheduler::run_whole_image(first);

        CellVolume<std::uint8_t> energies(extent, geometry.lanes());
        const auto bytes =
            make_ray_census_energy_stage(parameters, geometry, reference, partner, extent.rows);
        const CellSink<std::uint8_t> energy_sink(energies);
        const std::vector<const scheduler::RowStage*> second = {bytes.get(), &energy_sink};
        scheduler::run_whole_image(second);

        const float step = ray_census_energies(parameters).step;
        EXPECT_LE(-std::log(epsilon), epsilon < 1e-13 ? 1e9 : 255 * step);
        for (const auto [x, y] : positions_of(extent.columns, extent.rows)) {
          for (int i = 0; i < geometry.lanes(); ++i) {
            const int cell = energies.at(x, y, i);
            if (i >= geometry.count) {
              ASSERT_EQ(cell, 255);
              continue;
            }
            const double expected =
                std::min(255.0, -std::log(double{likelihoods.at(x, y, i)}) / step);
            ASSERT_NEAR(cell, expected, 0.5 + 1e-3) << "at " << x << ", " << y << ", " << i;
          }
        }
      }
    }
  }
}

}  // namespace vantage::stage_ray_census_energy_test
