#include "kernels/cell_smoothing/cell_smoothing.h"

#include <array>
#include <utility>

#include "kernels/candidates.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::cell_smoothing_test {

constexpr float kSentinel = -12345.5F;
/// Of the sum of the terms' absolute values: an ulp per operation, fewer than 150 of them.
constexpr double kRelativeError = 1e-5;

/// Floats of either sign and of several magnitudes, zeros among them.
float draw_cell(std::mt19937& random) {
  const int kind = random_int(random, 0, 9);
  const auto cell = static_cast<float>(random_int(random, -1000000, 1000000));
  return kind == 0 ? 0.0F : cell / (kind < 5 ? 997.0F : 1e6F);
}

UnalignedRow<float> draw_row(std::mt19937& random, std::size_t size, std::size_t offset) {
  UnalignedRow<float> row(size, offset);
  for (std::size_t i = 0; i < size; ++i) {
    row[i] = draw_cell(random);
  }
  return row;
}

/// A sum in double and the sum of the absolute values of its terms.
struct Sum {
  double value = 0;
  double magnitude = 0;
  void add(double term) {
    value += term;
    magnitude += std::abs(term);
  }
};

void expect_near(const std::vector<float>& actual, const std::vector<Sum>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    ASSERT_NEAR(actual[i], expected[i].value, kRelativeError * expected[i].magnitude)
        << "cell " << i;
  }
}

/// Runs of cells, of which those before `first` and behind `last` are absent.
struct Runs {
  std::vector<UnalignedRow<float>> memory;
  std::vector<const float*> addresses;
  std::vector<float> weights;

  Runs(std::mt19937& random, int radius, int first, int last, int count) {
    for (int k = -radius; k <= radius; ++k) {
      memory.push_back(draw_row(random, static_cast<std::size_t>(count), random() % 5));
    }
    for (int k = -radius; k <= radius; ++k) {
      const bool present = k >= first && k <= last;
      addresses.push_back(present ? memory[radius + k].data() : nullptr);
    }
    for (int k = 0; k <= radius; ++k) {
      weights.push_back(draw_cell(random));
    }
  }
  [[nodiscard]] SymmetricSum sum(int count) const {
    return {addresses.data(), weights.data(), static_cast<int>(weights.size()) - 1, count};
  }
  [[nodiscard]] std::vector<Sum> expected(int count) const {
    std::vector<Sum> sums(count);
    const int radius = static_cast<int>(weights.size()) - 1;
    for (int k = -radius; k <= radius; ++k) {
      const float* run = addresses[radius + k];
      for (std::size_t i = 0; run != nullptr && i < sums.size(); ++i) {
        sums[i].add(static_cast<double>(weights[std::abs(k)]) * run[i]);
      }
    }
    return sums;
  }
};

constexpr int kRadii[] = {0, 1, 2, 5, 8, 17, 64};
constexpr int kCounts[] = {16, 32, 48, 64, 80, 144, 272};

template <typename Check>
void for_each_case_of_runs(const Check& check) {
  std::mt19937 random(31);
  for (const int radius : kRadii) {
    for (const int count : kCounts) {
      // At both ends of the image, at one of them, at none, and in an image of one row.
      for (const auto& [first, last] : {std::pair{-radius, radius},
                                        {0, radius},
                                        {-radius, radius / 2},
                                        {-radius / 3, radius},
                                        {-radius / 2, radius / 3},
                                        {0, 0}}) {
        SCOPED_TRACE(testing::Message() << "radius " << radius << ", runs " << first << " to "
                                        << last << ", " << count << " cells");
        check(Runs(random, radius, first, last, count), count);
        if (testing::Test::HasFatalFailure()) {
          return;
        }
      }
    }
  }
}

TEST(CellSmoothing, AddsWeightedRuns) {
  for_each_case_of_runs([](const Runs& runs, int count) {
    expect_near(row_on_every_target<float>(count, symmetric_sum, runs.sum(count)),
                runs.expected(count));
  });
}

constexpr int kRadius = BoxCascade::kRadius;
constexpr int kRows = 2 * kRadius + 1;

/// Rows of a whole image around row y, of which some may be outside.
struct Rows {
  int width;
  int lanes;
  std::vector<UnalignedRow<float>> memory;

  Rows(std::mt19937& random, int width_columns, int lane_count)
      : width(width_columns), lanes(lane_count) {
    for (int k = 0; k < kRows; ++k) {
      memory.push_back(draw_row(random, size(width), random() % 5));
    }
  }
  [[nodiscard]] std::size_t size(int columns) const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(lanes);
  }
  /// Columns [begin, end) of rows first … last, in memory that ends there.
  [[nodiscard]] std::vector<UnalignedRow<float>> cut(int first, int last, int begin,
                                                     int end) const {
    std::vector<UnalignedRow<float>> rows;
    for (int k = first; k <= last; ++k) {
      UnalignedRow<float> row(size(end - begin), 1);
      std::copy_n(memory[k].data() + size(begin), row.size(), row.data());
      rows.push_back(std::move(row));
    }
    return rows;
  }
};

/// Which part of the image a call sees and makes; rows first … last of kRows are inside.
struct Part {
  int first_row;
  int last_row;
  int begin;
  int end;
};

std::vector<float> cascade(const Rows& whole, const Part& part) {
  BoxCascade cascade;
  cascade.input_begin = std::max(0, part.begin - kRadius);
  cascade.input_end = std::min(whole.width, part.end + kRadius);
  cascade.output_begin = part.begin;
  cascade.output_end = part.end;
  cascade.lanes = whole.lanes;
  const auto cut = whole.cut(part.first_row, part.last_row, cascade.input_begin, cascade.input_end);
  std::array<const float*, kRows> rows = {};
  for (int k = part.first_row; k <= part.last_row; ++k) {
    rows[k] = cut[k - part.first_row].data();
  }
  cascade.rows = rows.data();
  GuardedRow<float> work(whole.size(cascade.input_end - cascade.input_begin), 2, kSentinel);
  GuardedRow<float> output(whole.size(part.end - part.begin), 1, kSentinel);
  box_cascade_row(cascade, work.data(), output.data());
  EXPECT_TRUE(work.intact() && output.intact());
  return output.values();
}

/// Four boxes in either direction, one after the other, over an image with room for all that
/// leaves it.
std::vector<Sum> plain_cascade(const Rows& whole, const Part& part) {
  std::vector<double> kernel = {1};
  for (const int width : {3, 3, 3, 5}) {
    std::vector<double> wider(kernel.size() + static_cast<std::size_t>(width) - 1);
    for (std::size_t i = 0; i < kernel.size(); ++i) {
      for (std::size_t j = 0; j < static_cast<std::size_t>(width); ++j) {
        wider[i + j] += kernel[i] / width;
      }
    }
    kernel = wider;
  }
  std::vector<Sum> sums(whole.size(part.end - part.begin));
  for (int x = part.begin; x < part.end; ++x) {
    for (int k = part.first_row; k <= part.last_row; ++k) {
      for (int u = std::max(0, x - kRadius); u <= std::min(whole.width - 1, x + kRadius); ++u) {
        const double weight = kernel[k] * kernel[u - x + kRadius];
        for (std::size_t i = 0; i < whole.size(1); ++i) {
          sums[whole.size(x - part.begin) + i].add(weight * whole.memory[k][whole.size(u) + i]);
        }
      }
    }
  }
  return sums;
}

template <typename Check>
void for_each_part(const Check& check) {
  std::mt19937 random(32);
  for (const int lanes : {16, 48, 80}) {
    for (const int width : {1, 2, 4, 5, 9, 10, 11, 12, 23}) {
      const Rows whole(random, width, lanes);
      for (const int strip : {1, 3, 7, 23}) {
        for (int begin = 0; begin < width; begin += strip) {
          Part part{0, kRows - 1, begin, std::min(width, begin + strip)};
          // Inside the image, at its top, at its bottom, or both.
          if (random() % 2 == 0) {
            part.first_row = random_int(random, 0, kRadius);
            part.last_row = random_int(random, kRadius, kRows - 1);
          }
          SCOPED_TRACE(testing::Message()
                       << lanes << " lanes, width " << width << ", columns " << part.begin << " to "
                       << part.end << ", rows " << part.first_row << " to " << part.last_row);
          check(whole, part);
          if (testing::Test::HasFatalFailure()) {
            return;
          }
        }
      }
    }
  }
}

TEST(CellSmoothing, CascadeIsFourBoxesInBothDirections) {
  for_each_part([](const Rows& whole, const Part& part) {
    const std::vector<float> output = cascade(whole, part);
    expect_near(output, plain_cascade(whole, part));
    for_each_target([&] { ASSERT_EQ(cascade(whole, part), output); });
  });
}

TEST(CellSmoothing, StripsOfACascadeAreThoseOfTheWholeRow) {
  for_each_part([](const Rows& whole, const Part& part) {
    const std::vector<float> all = cascade(whole, {part.first_row, part.last_row, 0, whole.width});
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(whole.size(part.begin));
    const auto end = all.begin() + static_cast<std::ptrdiff_t>(whole.size(part.end));
    ASSERT_EQ(cascade(whole, part), std::vector<float>(begin, end));
  });
}

}  // namespace vantage::kernels::cell_smoothing_test
