#include "kernels/max_product_step/max_product_step.h"

#include <array>
#include <iterator>
#include <ostream>

#include "engine/image/image.h"
#include "kernels/candidates.h"
#include "tests/kernels/kernel_test_utils.h"
#include "tests/kernels/star_rows.h"
#include "tests/test_sample.h"

namespace vantage::kernels::max_product_step_test {

VANTAGE_ON_EVERY_TARGET(MaxProductStep);

using EnergyStarRows = CellStarRows<FixedEnergy>;
using Kernel = void (*)(const MaxProductRow&);

constexpr FixedEnergy kSentinel = -77;
/// A fixed weight's unit.
constexpr double kWeightSteps = 32768;

struct Shape {
  int columns;
  int count;
};
/// Some have more columns than fit work memory.
constexpr Shape kShapes[] = {{1, 1},  {2, 3},   {3, 16}, {40, 16}, {5, 17},  {1, 33},  {37, 48},
                             {4, 64}, {2, 113}, {1, 64}, {3, 128}, {20, 80}, {9, 300}, {2, 2100}};
constexpr int kRadii[] = {0, 1, 2, 3, 4, 5, 20};

/// Runs of lanes: one, every kLaneMultiple lanes one, or a cut behind the first ones.
std::vector<int> segment_ends(int lanes, int kind) {
  std::vector<int> ends;
  for (int end = kLaneMultiple; kind > 0 && end < lanes; end += kLaneMultiple) {
    if (kind == 1 || ends.empty()) {
      ends.push_back(end);
    }
  }
  if (kind > 0) {
    ends.push_back(lanes);
  }
  return ends;
}

struct Case {
  Shape shape;
  int radius;
  bool smooths;
  bool weighted;
  bool cuts;         ///< lanes into segments
  bool is_in_plane;  ///< candidates are displacements in two dimensions, if there are enough
  unsigned seed;

  [[nodiscard]] int lanes() const { return CandidateGeometry{.count = shape.count}.lanes(); }
  friend std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.shape.columns << " columns of " << c.shape.count << ", radius " << c.radius
               << ", smooths " << c.smooths << ", weighted " << c.weighted << ", cuts " << c.cuts
               << ", in plane " << c.is_in_plane << ", seed " << c.seed;
  }
};

template <typename Body>
void for_each_case(const Body& body) {
  static const auto rows = test::sampled_rows(
      {static_cast<int>(std::size(kShapes)), static_cast<int>(std::size(kRadii)), 2, 2, 3});
  unsigned seed = 0;
  for (const test::SampleRow& row : rows) {
    if (!testing::Test::HasFatalFailure()) {
      body(Case{kShapes[row[0]], kRadii[row[1]], row[2] == 1, row[3] == 1, row[4] == 1, row[4] == 2,
                ++seed});
    }
  }
}

/// Cells that begin at an aligned address, between sentinels that kernels must leave alone.
class GuardedCells {
 public:
  explicit GuardedCells(int cells) : memory_(cells + 2 * kGuard, 1) { memory_.fill(kSentinel); }

  [[nodiscard]] FixedEnergy* data() { return memory_.row(0) + kGuard; }
  [[nodiscard]] std::vector<FixedEnergy> values() const {
    return {memory_.row(0) + kGuard, memory_.row(0) + memory_.width() - kGuard};
  }
  [[nodiscard]] bool intact() const {
    const auto is_sentinel = [](FixedEnergy cell) { return cell == kSentinel; };
    const FixedEnergy* const end = memory_.row(0) + memory_.width();
    return std::all_of(memory_.row(0), memory_.row(0) + kGuard, is_sentinel) &&
           std::all_of(end - kGuard, end, is_sentinel);
  }

 private:
  static constexpr int kGuard = 64;
  Image<FixedEnergy> memory_;
};

template <std::size_t kChoices>
int one_of(std::mt19937& random, const int (&choices)[kChoices]) {
  return choices[random() % kChoices];
}

/// A row of random energies and whatever else it points at. What the star has in lanes that are no
/// candidates is as random as the rest.
class MadeUpRow {
 public:
  explicit MadeUpRow(const Case& c) : MadeUpRow(c, std::mt19937(c.seed)) {}

  [[nodiscard]] const MaxProductRow& row() const { return row_; }
  [[nodiscard]] EnergyStarRows& cells() { return cells_; }

  /// All that `kernel` leaves, what lies between columns included.
  [[nodiscard]] std::vector<FixedEnergy> result(Kernel kernel) const {
    const CellStarRow<FixedEnergy>& star = row_.star;
    const auto segments = static_cast<int>(std::max<std::size_t>(1, segment_ends_.size()));
    GuardedCells work(max_product_work_cells(star.lanes, row_.prior.radius, segments, row_.plane));
    GuardedCells output(static_cast<int>(row_.output_pitch) * star.columns);
    MaxProductRow row = row_;
    row.work = work.data();
    row.output = output.data();
    kernel(row);
    EXPECT_TRUE(work.intact());
    EXPECT_TRUE(output.intact());
    return output.values();
  }

 private:
  MadeUpRow(const Case& c, std::mt19937 random)
      : ceiling_(static_cast<FixedEnergy>(one_of(random, {90, 3000, 5400}))),
        cells_(c.shape.columns, c.lanes(), c.lanes() + one_of(random, {0, 16, 48}), 0,
               static_cast<float>(ceiling_) + 1, c.seed),
        segment_ends_(segment_ends(c.lanes(), c.cuts ? random_int(random, 1, 2) : 0)),
        source_pitch_(c.lanes() + one_of(random, {0, 16, 32})),
        source_(source_pitch_ * c.shape.columns, 1) {
    if (random() % 3 == 0) {
      cells_.remove_up(0);
    }
    make_source(c, random);
    const int unit = random_int(random, 1, ceiling_ / 2);
    for (int k = 1; k <= c.radius; ++k) {
      rises_.push_back(static_cast<FixedEnergy>(std::min(k * k * unit, ceiling_ - 1)));
    }
    row_.star = cells_.star();
    row_.star.source = source_.row(0);
    row_.prior = {rises_.data(), c.radius, ceiling_};
    row_.mu = static_cast<FixedWeight>(one_of(random, {0x4000, 0, 22938, 32767}));
    row_.smooths = c.smooths;
    row_.source_pitch = source_pitch_;
    row_.output_pitch = c.lanes() + one_of(random, {0, 16, 32});
    row_.segment_ends = segment_ends_;
    row_.plane = c.is_in_plane ? plane_of(c.shape.count, c.seed) : CandidatePlane{};
    if (c.weighted) {
      for (int k = 0; k < 3 * c.shape.columns + 1; ++k) {
        const int weight = one_of(random, {0, 1, 32767, random_int(random, 0, 32767)});
        weights_.push_back(static_cast<FixedWeight>(weight));
      }
      row_.weights = {.beside = weights_.data(),
                      .above = weights_.data() + c.shape.columns + 1,
                      .below = weights_.data() + 2 * c.shape.columns + 1};
    }
  }

  /// Energies above the least of their column, some of them far above all others.
  void make_source(const Case& c, std::mt19937& random) {
    source_.fill(0);  // what lies between columns would be the least of all
    for (int x = 0; x < c.shape.columns; ++x) {
      FixedEnergy* const column = source_.row(0) + x * source_pitch_;
      for (int i = 0; i < c.lanes(); ++i) {
        const int energy = one_of(random, {random_int(random, 0, ceiling_),
                                           random_int(random, 0, 2000), 30000, kMaxEnergy});
        column[i] = i < c.shape.count ? static_cast<FixedEnergy>(energy) : kMaxEnergy;
      }
      column[random() % static_cast<unsigned>(c.shape.count)] = 0;
    }
  }

  FixedEnergy ceiling_;
  EnergyStarRows cells_;
  std::vector<int> segment_ends_;
  int source_pitch_;
  Image<FixedEnergy> source_;
  std::vector<FixedEnergy> rises_;
  std::vector<FixedWeight> weights_;
  MaxProductRow row_;
};

/// E of the candidates of column x above the least of them, by the definition.
std::vector<double> plain_energies(const MaxProductRow& row, int count, int x, bool starts) {
  const CellStarRow<FixedEnergy>& star = row.star;
  const bool weighs = row.weights.are_given();
  struct Part {
    const FixedEnergy* cells;
    FixedWeight weight;
  };
  const FixedEnergy* const centre = star.centre + x * star.pitch;
  const Part parts[] = {
      {centre, row.mu},
      {x == 0 ? star.left_of_first : centre - star.pitch, weighs ? row.weights.beside[x] : row.mu},
      {x + 1 == star.columns ? star.right_of_last : centre + star.pitch,
       weighs ? row.weights.beside[x + 1] : row.mu},
      {star.up + x * star.up_pitch, weighs ? row.weights.above[x] : row.mu},
      {star.down + x * star.down_pitch, weighs ? row.weights.below[x] : row.mu}};
  std::vector<double> energies;
  for (int i = 0; i < count; ++i) {
    double energy = star.source[x * row.source_pitch + i];
    for (const Part& part : parts) {
      energy += starts ? 0 : part.weight / kWeightSteps * part.cells[i];
    }
    energies.push_back(row.smooths ? energy : std::min<double>(energy, kMaxEnergy));
  }
  const double min = *std::min_element(energies.begin(), energies.end());
  for (double& energy : energies) {
    energy -= min;
  }
  return energies;
}

/// ES of energies: each candidate looks at those of its segment within reach.
std::vector<double> plain_smoothed(const std::vector<double>& energies, const MaxProductRow& row) {
  const auto segment_of = [&row](int i) {
    return std::upper_bound(row.segment_ends.begin(), row.segment_ends.end(), i);
  };
  const auto count = static_cast<int>(energies.size());
  std::vector<double> smoothed;
  for (int i = 0; i < count; ++i) {
    double min = row.prior.ceiling;
    const int reach = row.prior.radius;
    const int in_row = row.plane.row_candidates;
    for (int j = 0; row.plane.is_given() && j < count; ++j) {
      const auto rise = [&](int offset) {
        return offset == 0 ? 0 : row.prior.rises[std::abs(offset) - 1];
      };
      const int across = i % in_row - j % in_row;
      const int down = i / in_row - j / in_row;
      if (std::abs(across) <= reach && std::abs(down) <= reach) {
        min = std::min(min, energies[j] + rise(across) + rise(down));
      }
    }
    if (row.plane.is_given()) {
      smoothed.push_back(min);
      continue;
    }
    for (int j = std::max(0, i - reach); j < std::min(count, i + reach + 1); ++j) {
      if (segment_of(i) == segment_of(j)) {
        const double rise = i == j ? 0 : row.prior.rises[std::abs(i - j) - 1];
        min = std::min(min, energies[j] + rise);
      }
    }
    smoothed.push_back(min);
  }
  return smoothed;
}

TEST(MaxProductStep, IsTheDefinitionToRounding) {
  double error_sum = 0;
  double candidates = 0;
  const auto check = [&](const Case& c) {
    const MadeUpRow made_up(c);
    const MaxProductRow& row = made_up.row();
    for (const bool starts : {true, false}) {
      const Kernel kernel = starts ? max_product_start_row : max_product_row;
      const std::vector<FixedEnergy> result = made_up.result(kernel);
      for_each_target([&] { ASSERT_EQ(made_up.result(kernel), result) << c; });
      for (int x = 0; x < c.shape.columns; ++x) {
        std::vector<double> expected = plain_energies(row, c.shape.count, x, starts);
        if (c.smooths) {
          expected = plain_smoothed(expected, row);
        }
        for (int i = 0; i < c.shape.count; ++i) {
          const double actual = result[x * row.output_pitch + i];
          const double error = std::abs(actual - expected[i]);
          // Half a step for each of five products, and as much of the least of the column.
          ASSERT_LE(error, starts ? 0 : 5) << c << ", column " << x << ", candidate " << i;
          error_sum += starts ? 0 : error;
          candidates += starts ? 0 : 1;
        }
      }
    }
  };
  for_each_case(check);
  // Pruned levels have such columns, which stay in registers.
  for (const int count : {32, 48, 64}) {
    for (const int radius : {1, 2}) {
      for (unsigned seed = 1; seed <= 4; ++seed) {
        check({{5, count}, radius, true, seed % 2 == 1, true, false, seed});
      }
    }
  }
  EXPECT_LE(error_sum / candidates, 0.75);
}

TEST_P(MaxProductStep, LeavesWhatLiesBetweenColumns) {
  for_each_case([](const Case& c) {
    const MadeUpRow made_up(c);
    const auto pitch = static_cast<int>(made_up.row().output_pitch);
    for (const Kernel kernel : {max_product_start_row, max_product_row}) {
      const std::vector<FixedEnergy> result = made_up.result(kernel);
      for (int cell = 0; cell < c.shape.columns * pitch; ++cell) {
        const bool is_lane = cell % pitch < c.lanes();
        ASSERT_EQ(result[cell] == kSentinel, !is_lane) << c;
      }
    }
  });
}

TEST_P(MaxProductStep, LanesThatAreNoCandidatesSayNothing) {
  for_each_case([](const Case& c) {
    std::vector<FixedEnergy> results[2];
    for (const FixedEnergy cell : {FixedEnergy{0}, FixedEnergy{90}}) {
      MadeUpRow made_up(c);
      const MaxProductRow& row = made_up.row();
      for (int x = -1; x <= c.shape.columns; ++x) {
        FixedEnergy* const column = made_up.cells().centre(x);
        std::fill(column + c.shape.count, column + c.lanes(), cell);
      }
      std::vector<FixedEnergy>& result = results[cell == 0 ? 0 : 1];
      result = made_up.result(max_product_row);
      for (int x = 0; x < c.shape.columns; ++x) {
        FixedEnergy* const column = result.data() + x * row.output_pitch;
        if (!c.smooths) {
          for (int lane = c.shape.count; lane < c.lanes(); ++lane) {
            ASSERT_GE(column[lane], *std::max_element(column, column + c.shape.count)) << c;
          }
        }
        std::fill(column + c.shape.count, column + c.lanes(), FixedEnergy{0});
      }
    }
    ASSERT_EQ(results[0], results[1]) << c;
  });
}

/// One column of kLaneMultiple lanes whose neighbours are columns of their own.
struct OneColumn {
  Image<FixedEnergy> neighbours{kLaneMultiple, 4};  // left, right, up, down
  Image<FixedEnergy> centre{kLaneMultiple, 1};
  Image<FixedEnergy> source{kLaneMultiple, 1};
  Image<FixedEnergy> output{kLaneMultiple, 1};
  Image<FixedEnergy> work{max_product_work_cells(kLaneMultiple, kLaneMultiple), 1};
  MaxProductRow row;

  /// Candidates have the energies given at first.
  explicit OneColumn(const std::vector<int>& energies) {
    neighbours.fill(0);
    centre.fill(0);
    source.fill(kMaxEnergy);
    for (std::size_t i = 0; i < energies.size(); ++i) {
      source.row(0)[i] = static_cast<FixedEnergy>(energies[i]);
    }
    row.star.centre = centre.row(0);
    row.star.left_of_first = neighbours.row(0);
    row.star.right_of_last = neighbours.row(1);
    row.star.up = neighbours.row(2);
    row.star.down = neighbours.row(3);
    row.star.source = source.row(0);
    row.star.pitch = row.source_pitch = row.output_pitch = kLaneMultiple;
    row.star.columns = 1;
    row.star.lanes = kLaneMultiple;
    row.prior.ceiling = 5000;
    row.smooths = false;
    row.output = output.row(0);
    row.work = work.row(0);
  }
};

TEST_P(MaxProductStep, EachNeighbourHasItsOwnWeight) {
  // Two candidates, and one neighbour at a time that is for the second.
  const std::array<FixedWeight, 4> weights{fixed_weight(0.25F), fixed_weight(0.5F),
                                           fixed_weight(0.75F), fixed_weight(1)};
  for (int k = 0; k < 4; ++k) {
    OneColumn column({0, 0});
    column.neighbours.at(0, k) = 1024;
    column.row.weights = {weights.data(), weights.data() + 2, weights.data() + 3};
    max_product_row(column.row);
    EXPECT_EQ(column.output.at(0, 0), 256 * (k + 1)) << k;
    EXPECT_EQ(column.output.at(1, 0), 0) << k;
    column.row.weights = {};
    column.row.mu = fixed_weight(0.375F);
    max_product_row(column.row);
    EXPECT_EQ(column.output.at(0, 0), 384) << k;
  }
}

TEST_P(MaxProductStep, TheCentreCountsMuWithAndWithoutWeights) {
  const std::array<FixedWeight, 4> weights{fixed_weight(1), fixed_weight(1), fixed_weight(1),
                                           fixed_weight(1)};
  OneColumn column({0, 0});
  column.row.mu = fixed_weight(0.375F);
  column.centre.at(1, 0) = 1024;
  max_product_row(column.row);
  EXPECT_EQ(column.output.at(0, 0), 0);
  EXPECT_EQ(column.output.at(1, 0), 384);
  column.row.weights = {weights.data(), weights.data() + 2, weights.data() + 3};
  max_product_row(column.row);
  EXPECT_EQ(column.output.at(1, 0), 384);
}

TEST_P(MaxProductStep, NeighboursAreAsGoodAsTheirOffsetAllows) {
  const std::vector<int> energies{25, 200, 20, 1000, 1000, 1000, 90, 1000};
  const std::vector<int> expected{5, 10, 0, 10, 40, 80, 70, 80};
  OneColumn column(energies);
  const FixedEnergy rises[] = {10, 40};
  column.row.prior = {rises, 2, 150};
  column.row.smooths = true;
  max_product_start_row(column.row);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(column.output.row(0)[i], expected[i]) << i;
  }
  EXPECT_EQ(column.output.at(8, 0), 110);  // no candidate, two beside one
  EXPECT_EQ(column.output.at(9, 0), 150);
  // An iteration without neighbours that say anything makes the same of them.
  column.output.fill(kSentinel);
  max_product_row(column.row);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(column.output.row(0)[i], expected[i]) << i;
  }
}

TEST_P(MaxProductStep, ColumnsWithoutCandidatesAreNeutral) {
  OneColumn column({});
  for (const bool smooths : {false, true}) {
    column.row.smooths = smooths;
    max_product_row(column.row);
    EXPECT_EQ(std::vector<FixedEnergy>(column.output.row(0), column.output.row(0) + kLaneMultiple),
              std::vector<FixedEnergy>(kLaneMultiple, 0));
  }
}

TEST(MaxProductWork, HoldsColumnsAndTheirMargins) {
  EXPECT_EQ(max_product_work_margin(0), 0);
  EXPECT_EQ(max_product_work_margin(1), 16);
  EXPECT_EQ(max_product_work_margin(16), 16);
  EXPECT_EQ(max_product_work_margin(17), 32);
  EXPECT_EQ(max_product_work_columns(16), 16);
  EXPECT_EQ(max_product_work_columns(304), 6);
  EXPECT_EQ(max_product_work_columns(4096), 1);
  EXPECT_EQ(max_product_work_cells(48, 1), 16 * (48 + 2 * 16));
  EXPECT_EQ(max_product_work_cells(304, 1, 3), 6 * (304 + 4 * 16));
}

}  // namespace vantage::kernels::max_product_step_test
