#include "engine/matching/noise/noise_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/image/intensity_rows.h"

namespace vantage {
namespace {

constexpr int kMarginPx = 2;  ///< of the filters
constexpr int kMinSidePx = 64;
constexpr int kMaxBlocks = 1200;
constexpr int kMinBlocks = 50;
/// Share of the blocks, those with the least energy, in which noise is measured. The energy of
/// white noise differs between blocks: these have this part of its standard deviation.
constexpr double kSmoothestShare = 0.02;
constexpr double kSmoothestDeviation = 0.70;
/// Blocks that reach nearer to black or white are cut off there.
constexpr float kDarkest = 3;
constexpr float kBrightest = 252;
/// Differences count up to this: those of blocks are small, those of edges are not.
constexpr float kMaxStep = 4;

struct Block {
  float energy = 0;  ///< mean square of second differences
  BlockPlace place;
};

/// What is measured in one row of blocks.
struct BlockRow {
  std::vector<Block> blocks;
  std::vector<float> column_steps;  ///< between columns x and x + 1, summed over the rows
  std::array<double, kNoiseBlockPx> row_steps;  ///< between rows y and y + 1, by y modulo 8
};

using Rows = std::array<const float*, kNoiseBlockPx + 2 * kMarginPx>;

float step(float first, float second) { return std::min(std::abs(second - first), kMaxStep); }

/// Σ step(): in as many sums as vectors have lanes.
double sum_of_steps(const float* first, const float* second, int width) {
  std::array<float, 8> sums{};
  for (int x = 0; x + 8 <= width; x += 8) {
    for (int lane = 0; lane < 8; ++lane) {
      sums[static_cast<std::size_t>(lane)] += step(first[x + lane], second[x + lane]);
    }
  }
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

/// What is gathered in each column of a row of blocks. Loops over columns are vectors.
struct ColumnSums {
  explicit ColumnSums(int width)
      : darkest(static_cast<std::size_t>(width), kBrightest),
        brightest(static_cast<std::size_t>(width), kDarkest),
        energy(static_cast<std::size_t>(width), 0),
        steps(static_cast<std::size_t>(width) - 1, 0) {}

  void add(const float* up, const float* centre, const float* down) {
    const auto width = static_cast<int>(energy.size());
    float* const energies = energy.data();
    float* const dark = darkest.data();
    float* const bright = brightest.data();
    float* const beside = steps.data();
    for (int x = 1; x < width - 1; ++x) {
      const float difference = second_difference(up, centre, down, x);
      energies[x] += difference * difference;
    }
    for (int x = 0; x < width; ++x) {
      dark[x] = std::min(dark[x], centre[x]);
      bright[x] = std::max(bright[x], centre[x]);
    }
    for (int x = 0; x < width - 1; ++x) {
      beside[x] += step(centre[x], centre[x + 1]);
    }
  }

  std::vector<float> darkest;
  std::vector<float> brightest;
  std::vector<float> energy;
  std::vector<float> steps;  ///< between columns x and x + 1
};

BlockRow measure_row(const Photograph& photograph, int y_begin, std::span<float> memory) {
  const int width = photograph.width();
  Rows rows;
  std::array<double, std::tuple_size_v<Rows> - 1> steps{};  // between rows i and i + 1
  for (std::size_t i = 0; i < rows.size(); ++i) {
    float* row = memory.data() + i * static_cast<std::size_t>(width);
    intensity_row(photograph, y_begin - kMarginPx + static_cast<int>(i), row);
    rows[i] = row;
    if (i > 0) {
      steps[i - 1] = sum_of_steps(rows[i - 1], row, width);
    }
  }
  ColumnSums sums(width);
  BlockRow result;
  for (std::size_t i = kMarginPx; i < kMarginPx + kNoiseBlockPx; ++i) {
    sums.add(rows[i - 1], rows[i], rows[i + 1]);
    result.row_steps[(static_cast<std::size_t>(y_begin) + i - kMarginPx) % kNoiseBlockPx] =
        2 * steps[i] - steps[i - 1] - steps[i + 1];
  }
  for (int x = kMarginPx; x + kNoiseBlockPx + kMarginPx <= width; x += kNoiseBlockPx) {
    const auto of_block = [x](const std::vector<float>& columns) {
      return std::span(columns).subspan(static_cast<std::size_t>(x), kNoiseBlockPx);
    };
    // Blocks that black or white cut off would look smooth.
    if (std::ranges::min(of_block(sums.darkest)) > kDarkest &&
        std::ranges::max(of_block(sums.brightest)) < kBrightest) {
      const auto energies = of_block(sums.energy);
      const float energy = std::accumulate(energies.begin(), energies.end(), 0.0F);
      result.blocks.push_back({energy / (36 * kNoiseBlockPx * kNoiseBlockPx), {x, y_begin}});
    }
  }
  result.column_steps = std::move(sums.steps);
  return result;
}

/// The largest of eight means over its standard error. samples: by phase.
double largest_score(const std::array<std::vector<double>, kNoiseBlockPx>& samples) {
  double largest = 0;
  for (const std::vector<double>& phase : samples) {
    double sum = 0;
    double squares = 0;
    for (const double sample : phase) {
      sum += sample;
      squares += sample * sample;
    }
    const auto count = static_cast<double>(phase.size());
    const double mean = sum / count;
    const double variance = squares / count - mean * mean;
    if (count > 1 && variance > 0) {
      largest = std::max(largest, mean / std::sqrt(variance / count));
    }
  }
  return largest;
}

double block_score(const std::vector<BlockRow>& rows, int width) {
  std::array<std::vector<double>, kNoiseBlockPx> between_columns;
  std::array<std::vector<double>, kNoiseBlockPx> between_rows;
  std::vector<double> steps(static_cast<std::size_t>(width) - 1, 0);
  for (const BlockRow& row : rows) {
    for (std::size_t x = 0; x < steps.size(); ++x) {
      steps[x] += row.column_steps[x];
    }
    for (std::size_t phase = 0; phase < kNoiseBlockPx; ++phase) {
      between_rows[phase].push_back(row.row_steps[phase]);
    }
  }
  for (std::size_t x = 1; x + 1 < steps.size(); ++x) {
    between_columns[x % kNoiseBlockPx].push_back(2 * steps[x] - steps[x - 1] - steps[x + 1]);
  }
  return std::max(largest_score(between_columns), largest_score(between_rows));
}

}  // namespace

NoiseEstimate estimate_noise(const Photograph& photograph, Execution& execution) {
  const int width = photograph.width();
  const int height = photograph.height();
  if (std::min(width, height) < kMinSidePx) {
    return {};
  }
  const int blocks_of_row = (width - 2 * kMarginPx) / kNoiseBlockPx;
  const int possible = (height - 2 * kMarginPx) / kNoiseBlockPx;
  const int count = std::clamp(kMaxBlocks / blocks_of_row, 1, possible);
  std::vector<BlockRow> rows(static_cast<std::size_t>(count));
  execution.for_each_band(count, [&](int first, int end) {
    const std::size_t floats = static_cast<std::size_t>(width) * std::tuple_size_v<Rows>;
    const auto work = execution.scratch().lease(sizeof(float) * floats);
    for (int i = first; i < end; ++i) {
      const auto block = static_cast<long long>(i) * possible / count;
      rows[static_cast<std::size_t>(i)] =
          measure_row(photograph, kMarginPx + static_cast<int>(block) * kNoiseBlockPx,
                      {reinterpret_cast<float*>(work.data()), floats});
    }
  });
  NoiseEstimate result{.block_score = block_score(rows, width)};
  std::vector<Block> blocks;
  for (const BlockRow& row : rows) {
    blocks.insert(blocks.end(), row.blocks.begin(), row.blocks.end());
  }
  if (blocks.size() < kMinBlocks) {
    return result;
  }
  std::ranges::stable_sort(blocks, {}, &Block::energy);
  blocks.resize(static_cast<std::size_t>(
      std::max(10.0, kSmoothestShare * static_cast<double>(blocks.size()))));
  double energy = 0;
  for (const Block& block : blocks) {
    energy += block.energy;
    result.smoothest.push_back(block.place);
  }
  result.floor_grey_levels =
      std::sqrt(energy / static_cast<double>(blocks.size())) / kSmoothestDeviation;
  return result;
}

namespace {

/// Whether codecs rounded all images coarsely, as their files state; empty: not stated.
std::optional<bool> stated_coding(std::span<const Photograph* const> photographs) {
  constexpr double kMinStep = 2;  // a JPEG of quality 92
  bool are_coarse = true;
  for (const Photograph* photograph : photographs) {
    const auto& coding = photograph->origin.coding;
    if (!coding || coding->step_grey_levels == 0) {
      return {};
    }
    are_coarse = are_coarse && coding->step_grey_levels >= kMinStep;
  }
  return are_coarse;
}

}  // namespace

FoundNoise find_noise(std::span<const Photograph* const> photographs,
                      const std::optional<DisparityRange>& disparities, Execution& execution) {
  constexpr double kMinBlockScore = 4.5;
  constexpr double kMinNoise = 2.5;
  constexpr double kMaxNoise = 32;  // above it is a texture of dots
  FoundNoise found;
  bool are_coded = true;
  bool are_noisy = true;
  std::vector<NoiseEstimate> estimates;
  for (const Photograph* photograph : photographs) {
    const NoiseEstimate& of_image = estimates.emplace_back(estimate_noise(*photograph, execution));
    are_coded = are_coded && of_image.block_score >= kMinBlockScore;
    are_noisy = are_noisy && of_image.floor_grey_levels >= kMinNoise &&
                of_image.floor_grey_levels <= kMaxNoise;
    found.grey_levels += of_image.floor_grey_levels / static_cast<double>(photographs.size());
    found.block_score = photograph == photographs.front()
                            ? of_image.block_score
                            : std::min(found.block_score, of_image.block_score);
  }
  if (stated_coding(photographs).value_or(are_coded)) {
    found.kind = NoiseKind::kCodec;
  } else if (are_noisy &&
             !(disparities && is_shared_texture(*photographs[0], *photographs[1],
                                                estimates.front().smoothest, *disparities))) {
    found.kind = NoiseKind::kSensor;
  }
  return found;
}

}  // namespace vantage
