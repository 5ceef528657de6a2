#include "kernels/row_sum/row_sum.h"

#include "kernels/candidates.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::row_sum_test {

constexpr std::int32_t kSentinel = -0x5A5A5A5B;
constexpr int kWidths[] = {1, 2, 3, 5, 7, 8, 13, 16, 17, 31, 40};
constexpr int kRadii[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 23, 60};
constexpr int kStripColumns[] = {1, 3, 16, 40};

/// The cells of a whole image row and their sums over windows, from prefix sums.
struct WholeRow {
  int width;
  int lanes;
  std::vector<std::int32_t> cells;
  std::vector<std::int64_t> sums_before;  // [x][lane]: sum of columns 0 … x − 1

  WholeRow(std::mt19937& random, int width_columns, int lane_count, bool worst)
      : width(width_columns),
        lanes(lane_count),
        cells(size(width)),
        sums_before(size(width + 1), 0) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      cells[i] = worst ? (random() % 2 == 0 ? INT32_MAX : INT32_MIN)
                       : static_cast<std::int32_t>(random() % 100000);
      sums_before[i + size(1)] = sums_before[i] + cells[i];
    }
  }
  [[nodiscard]] std::size_t size(int columns) const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(lanes);
  }
  [[nodiscard]] std::int32_t window_sum(int x, int radius, int lane) const {
    const int begin = std::max(0, x - radius);
    const int end = std::min(width, x + radius + 1);
    const auto at = [&](int column) {
      return sums_before[size(column) + static_cast<std::size_t>(lane)];
    };
    return modulo_32_bits(at(end) - at(begin));
  }
};

/// What one call is asked for besides the sums of a strip.
struct Wanted {
  bool number_lanes;
  bool output;
  bool minima;
  int slack_columns;  ///< columns of input beyond those needed, on either side
};

void check(std::mt19937& random, const WholeRow& whole, int radius, int begin, int end,
           const Wanted& wanted) {
  const int needed_begin = std::max(0, begin - radius - wanted.slack_columns);
  const int needed_end = std::min(whole.width, end + radius + wanted.slack_columns);
  const std::size_t offset = random() % 5;
  // Exactly the columns that the kernel may read.
  UnalignedRow<std::int32_t> input(whole.size(needed_end - needed_begin), offset);
  std::copy_n(whole.cells.begin() + static_cast<std::ptrdiff_t>(whole.size(needed_begin)),
              input.size(), input.data());
  const int candidates = random_int(random, 1, whole.lanes);

  std::vector<std::int32_t> expected;
  std::vector<std::int32_t> expected_minima;
  for (int x = begin; x < end; ++x) {
    for (int i = 0; i < whole.lanes; ++i) {
      expected.push_back(modulo_32_bits(static_cast<std::int64_t>(whole.window_sum(x, radius, i)) +
                                        (wanted.number_lanes ? i : 0)));
    }
    const auto column = expected.end() - whole.lanes;
    expected_minima.push_back(*std::min_element(column, column + candidates));
  }

  GuardedRow<std::int32_t> output(expected.size(), offset + 1, kSentinel);
  GuardedRow<std::int32_t> minima(expected_minima.size(), offset + 2, kSentinel);
  GuardedRow<std::int32_t> work(expected_minima.size() * kLaneMultiple, 0, kSentinel);
  RowSum row;
  row.input = input.data();
  row.input_begin = needed_begin;
  row.input_end = needed_end;
  row.output_begin = begin;
  row.output_end = end;
  row.radius = radius;
  row.lanes = whole.lanes;
  row.number_lanes = wanted.number_lanes;
  row.output = wanted.output ? output.data() : nullptr;
  if (wanted.minima) {
    row.minima = minima.data();
    row.candidates = candidates;
    row.minima_work = work.data();
  }
  row_sum(row);
  if (wanted.output) {
    ASSERT_EQ(output.values(), expected);
  }
  if (wanted.minima) {
    ASSERT_EQ(minima.values(), expected_minima) << candidates << " candidates";
  }
  ASSERT_TRUE(output.intact() && minima.intact() && work.intact());
}

VANTAGE_ON_EVERY_TARGET(RowSumOn);

TEST_P(RowSumOn, SumsWindowsCutToTheImage) {
  std::mt19937 random(21);
  constexpr Wanted kinds[] = {{false, true, false, 0}, {true, true, false, 1},
                              {true, false, true, 0},  {true, true, true, 2},
                              {false, true, true, 0},  {false, false, true, 50}};
  std::size_t kind = 0;
  for (const int lanes : kLaneCounts) {
    for (const int width : kWidths) {
      const WholeRow plain(random, width, lanes, false);
      const WholeRow worst(random, width, lanes, true);
      for (const int radius : kRadii) {
        for (const int strip : kStripColumns) {
          // Kinds rotate; 6 has no factor in common with the 11 widths.
          const Wanted& wanted = kinds[kind++ % std::size(kinds)];
          for (int begin = 0; begin < width; begin += strip) {
            const int end = std::min(begin + strip, width);
            SCOPED_TRACE(testing::Message() << lanes << " lanes, width " << width << ", radius "
                                            << radius << ", columns " << begin << " to " << end
                                            << ", numbers " << wanted.number_lanes << ", output "
                                            << wanted.output << ", minima " << wanted.minima);
            check(random, random() % 4 == 0 ? worst : plain, radius, begin, end, wanted);
            if (testing::Test::HasFatalFailure()) {
              return;
            }
          }
        }
      }
    }
  }
}

// A row made in blocks, each of which goes on with the window of the one before, also in a strip
// whose input begins and ends inside the image.
TEST_P(RowSumOn, BlocksGoOnWhereTheOneBeforeEnded) {
  std::mt19937 random(22);
  for (const int lanes : {16, 80}) {
    for (const int width : {1, 2, 7, 16, 31, 40}) {
      const WholeRow whole(random, width, lanes, false);
      for (const int radius : kRadii) {
        for (const int block : {1, 2, 5, 16}) {
          const int begin = random_int(random, 0, width - 1);
          const int end = random_int(random, begin + 1, width);
          const int input_begin = std::max(0, begin - radius);
          const int input_end = std::min(width, end + radius);
          std::vector<std::int32_t> window_sums(lanes);
          for (int x = begin; x < end; x += block) {
            std::vector<std::int32_t> output(whole.size(std::min(block, end - x)));
            RowSum row;
            row.input = whole.cells.data() + whole.size(input_begin);
            row.input_begin = input_begin;
            row.input_end = input_end;
            row.output_begin = x;
            row.output_end = std::min(x + block, end);
            row.radius = radius;
            row.lanes = lanes;
            row.number_lanes = true;
            row.window_sums = window_sums.data();
            row.continues = x > begin;
            row.output = output.data();
            row_sum(row);
            for (int column = x; column < row.output_end; ++column) {
              for (int i = 0; i < lanes; ++i) {
                ASSERT_EQ(output[whole.size(column - x) + static_cast<std::size_t>(i)],
                          whole.window_sum(column, radius, i) + i)
                    << lanes << " lanes, width " << width << ", radius " << radius << ", block "
                    << block << ", strip " << begin << " to " << end << ", column " << column;
              }
            }
          }
        }
      }
    }
  }
}

TEST_P(RowSumOn, MakesNothingOfNoColumns) {
  GuardedRow<std::int32_t> output(0, 0, kSentinel);
  const std::vector<std::int32_t> input(16 * 3, 1);
  RowSum row;
  row.input = input.data();
  row.input_end = 3;
  row.output_begin = row.output_end = 2;
  row.radius = 1;
  row.lanes = 16;
  row.output = output.data();
  row_sum(row);
  EXPECT_TRUE(output.intact());
}

}  // namespace vantage::kernels::row_sum_test
