#include "engine/matching/aggregation/stage_smoothing.h"

#include "engine/simd.h"
#include "tests/engine/cell_stages.h"
#include "tests/engine/engine_test.h"

namespace vantage::stage_smoothing_test {

using scheduler::Extent;
using Stages = std::vector<std::unique_ptr<scheduler::RowStage>>;

/// Of the sum of the absolute values of all terms: what rounding to floats may cost.
constexpr double kRelativeError = 1e-5;

constexpr Extent kSizes[] = {{1, 1}, {1, 7}, {7, 1}, {5, 3}, {37, 23}};

kernels::CandidateGeometry geometry_of(Extent extent, int count) {
  return {extent.columns, 0, count, -1};
}

/// Whole kernels in double, straight from their definitions.
std::vector<double> sampled_gaussian(double sigma_px) {
  const int radius = static_cast<int>(std::ceil(4 * sigma_px));
  std::vector<double> kernel;
  for (int k = -radius; k <= radius; ++k) {
    kernel.push_back(std::exp(-k * k / (2 * sigma_px * sigma_px)));
  }
  const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
  for (double& weight : kernel) {
    weight /= sum;
  }
  return kernel;
}

std::vector<double> boxes(const std::vector<int>& widths) {
  std::vector<double> kernel = {1};
  for (const int width : widths) {
    std::vector<double> wider(kernel.size() + static_cast<std::size_t>(width) - 1);
    for (std::size_t i = 0; i < wider.size(); ++i) {
      for (std::size_t j = 0; j < kernel.size(); ++j) {
        wider[i] += i >= j && i - j < static_cast<std::size_t>(width) ? kernel[j] / width : 0;
      }
    }
    kernel = wider;
  }
  return kernel;
}

/// Convolves cell by cell in both directions, cells outside the image being 0.
void expect_convolved(const CellVolume<float>& input, const CellVolume<float>& actual,
                      const std::vector<double>& kernel) {
  const int radius = static_cast<int>(kernel.size() / 2);
  const auto [columns, rows] = input.extent;
  for (const auto [x, y] : positions_of(columns, rows)) {
    for (int i = 0; i < input.lanes; ++i) {
      double sum = 0;
      double magnitude = 0;
      for (int v = std::max(0, y - radius); v <= std::min(rows - 1, y + radius); ++v) {
        for (int u = std::max(0, x - radius); u <= std::min(columns - 1, x + radius); ++u) {
          const double term = kernel[static_cast<std::size_t>(v - y + radius)] *
                              kernel[static_cast<std::size_t>(u - x + radius)] * input.at(u, v, i);
          sum += term;
          magnitude += std::abs(term);
        }
      }
      ASSERT_NEAR(actual.at(x, y, i), sum, kRelativeError * magnitude)
          << "column " << x << ", row " << y << ", lane " << i;
    }
  }
}

void expect_every_size(const std::function<Stages(const kernels::CandidateGeometry&, int)>& make,
                       const std::vector<double>& kernel) {
  for (const Extent extent : kSizes) {
    for (const int count : {5, 40}) {
      SCOPED_TRACE(::testing::Message()
                   << extent.columns << "x" << extent.rows << ", " << count << " candidates");
      const kernels::CandidateGeometry geometry = geometry_of(extent, count);
      const CellVolume<float> input = random_cells(extent, geometry.lanes(), -50, 6);
      const Stages stages = make(geometry, extent.rows);
      expect_convolved(input, run_every_way<float>(input, stages), kernel);
      if (::testing::Test::HasFatalFailure()) {
        return;
      }
    }
  }
}

TEST(GaussianStages, ConvolveWithASampledGaussian) {
  for (const double sigma_px : {0.5, 2.0, 2.3}) {
    SCOPED_TRACE(sigma_px);
    expect_every_size([&](const auto& geometry,
                          int height) { return make_gaussian_stages(geometry, height, sigma_px); },
                      sampled_gaussian(sigma_px));
  }
}

TEST(BoxCascadeStages, ConvolveWithTheCompositeOfFourBoxes) {
  const std::pair<double, std::vector<int>> cases[] = {
      {0.5, {}}, {2.0, {3, 3, 3, 5}}, {1.2, {1, 1, 3, 3}}, {2.6, {3, 5, 5, 5}}};
  for (const auto& [sigma_px, widths_px] : cases) {
    SCOPED_TRACE(sigma_px);
    expect_every_size(
        [sigma = sigma_px](const auto& geometry, int height) {
          return make_box_cascade_stages(geometry, height, sigma);
        },
        boxes(widths_px));
  }
}

// Nothing but the composite kernel, applied once, keeps what leaves the image from coming back.
TEST(BoxCascadeStages, CountCellsOutsideTheImageOnce) {
  const kernels::CandidateGeometry geometry = geometry_of({1, 1}, 16);
  CellVolume<float> input({1, 1}, 16);
  std::fill(input.cells.begin(), input.cells.end(), 1.0F);
  const CellVolume<float> output =
      run_every_way<float>(input, make_box_cascade_stages(geometry, 1, 2));
  EXPECT_NEAR(output.at(0, 0, 7), 25.0 * 25 / (135 * 135), 1e-8);
}

TEST(SmoothingStages, GiveTheSameBitsOnEveryInstructionSet) {
  const Extent extent = {29, 17};
  const kernels::CandidateGeometry geometry = geometry_of(extent, 70);
  const CellVolume<float> input = random_cells(extent, geometry.lanes(), -50, 7);
  const auto run = [&](const Stages& stages) {
    CellVolume<float> output(extent, geometry.lanes());
    const CellSource source(input);
    const CellSink<float> sink(output);
    std::vector<const scheduler::RowStage*> chain = {&source};
    for (const auto& stage : stages) {
      chain.push_back(stage.get());
    }
    chain.push_back(&sink);
    scheduler::run_whole_image(chain);
    return output.cells;
  };
  std::vector<std::vector<float>> first;
  for (const std::string& name : available_instruction_sets()) {
    force_instruction_set(name);
    const std::vector<std::vector<float>> results = {
        run(make_gaussian_stages(geometry, extent.rows, 2)),
        run(make_box_cascade_stages(geometry, extent.rows, 2)),
        run(make_box_cascade_stages(geometry, extent.rows, 3))};
    first = first.empty() ? results : first;
    EXPECT_EQ(results, first) << name;
  }
  force_instruction_set("best");
}

}  // namespace vantage::stage_smoothing_test
