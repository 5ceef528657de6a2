#include "kernels/column_ssd/column_ssd.h"

#include "kernels/candidates.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::column_ssd_test {

constexpr std::int32_t kSentinel = -0x5A5A5A5B;
constexpr int kMaxShift = 6;

std::size_t rounded_up(int count) {
  return static_cast<std::size_t>((count + kLaneMultiple - 1) / kLaneMultiple * kLaneMultiple);
}

/// Which rows there are: at the top and bottom of an image one is missing.
struct Rows {
  bool entering;
  bool leaving;
};
constexpr Rows kAllRows[] = {{true, true}, {true, false}, {false, true}, {false, false}};

enum class Data { kRandom, kWorst };

std::uint8_t draw_pixel(std::mt19937& random, Data data) {
  return static_cast<std::uint8_t>(data == Data::kRandom ? random() : (random() % 2) * 255);
}

/// The sums of a row of cells and of the one before, random anywhere in 32 bits.
std::vector<std::int32_t> draw_previous(std::mt19937& random, std::size_t cells) {
  std::vector<std::int32_t> previous(cells);
  for (std::int32_t& sum : previous) {
    sum = static_cast<std::int32_t>(random());
  }
  return previous;
}

/// Places of the partners of `columns` columns with `lanes` candidates, as the stages lay them out.
std::size_t partner_count(int columns, int lanes) {
  return static_cast<std::size_t>(columns - 1 + lanes);
}
int first_partner(int partner_step, int columns) { return partner_step < 0 ? columns - 1 : 0; }

/// Runs a kernel beside `previous` and in place; both must give `expected`.
template <typename Row, typename Kernel>
void expect_sums(const Kernel& kernel, const Row& row, const std::vector<std::int32_t>& previous,
                 const std::vector<std::int32_t>& expected, std::size_t offset) {
  GuardedRow<std::int32_t> sums(expected.size(), offset, kSentinel);
  kernel(row, previous.data(), sums.data());
  ASSERT_EQ(sums.values(), expected);
  ASSERT_TRUE(sums.intact());
  std::vector<std::int32_t> in_place = previous;
  kernel(row, in_place.data(), in_place.data());
  ASSERT_EQ(in_place, expected) << "in place";
}

/// A row of 8-bit pixels before and after the window moves down.
struct PixelRows {
  std::vector<std::uint8_t> entering;
  std::vector<std::uint8_t> leaving;

  PixelRows(std::mt19937& random, Data data, std::size_t size)
      : entering(rounded_up(static_cast<int>(size))), leaving(entering.size()) {
    for (std::size_t i = 0; i < entering.size(); ++i) {
      entering[i] = draw_pixel(random, data);
      leaving[i] = draw_pixel(random, data);
    }
  }
  [[nodiscard]] UnalignedRow<std::int32_t> pairs(Rows rows, int shift, std::size_t size,
                                                 std::size_t offset) const {
    std::vector<std::int32_t> all(rounded_up(static_cast<int>(size)));
    interleave_rows(rows.entering ? entering.data() : nullptr,
                    rows.leaving ? leaving.data() : nullptr, shift, static_cast<int>(size),
                    all.data());
    UnalignedRow<std::int32_t> exact(size, offset);
    std::copy_n(all.begin(), size, exact.data());
    return exact;
  }
};

/// One case of the 8-bit kernel; sums from the pixels themselves.
template <typename Kernel>
void check_pairs(const Kernel& kernel, std::mt19937& random, Data data, Rows rows, int partner_step,
                 int columns, int lanes) {
  const int shift = random_int(random, 0, kMaxShift);
  const std::size_t offset = random() % 5;
  const std::size_t partners = partner_count(columns, lanes);
  const PixelRows reference(random, data, static_cast<std::size_t>(columns));
  const PixelRows partner(random, data, partners);
  const auto reference_pairs =
      reference.pairs(rows, shift, static_cast<std::size_t>(columns), offset);
  const auto partner_pairs = partner.pairs(rows, shift, partners, offset + 1);

  const std::size_t cells = static_cast<std::size_t>(columns) * static_cast<std::size_t>(lanes);
  const std::vector<std::int32_t> previous = draw_previous(random, cells);
  std::vector<std::int32_t> expected(cells);
  const std::int64_t unit = std::int64_t{1} << (2 * shift);
  const int first = first_partner(partner_step, columns);
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < lanes; ++i) {
      const auto k = static_cast<std::size_t>(first + j * partner_step + i);
      const auto column = static_cast<std::size_t>(j);
      const std::size_t cell =
          column * static_cast<std::size_t>(lanes) + static_cast<std::size_t>(i);
      const std::int64_t enters = reference.entering[column] - partner.entering[k];
      const std::int64_t leaves = reference.leaving[column] - partner.leaving[k];
      expected[cell] =
          modulo_32_bits(previous[cell] + (rows.entering ? unit * enters * enters : 0) -
                         (rows.leaving ? unit * leaves * leaves : 0));
    }
  }
  const ColumnSsdPairs row{reference_pairs.data(), partner_pairs.data() + first, partner_step,
                           columns, lanes};
  expect_sums(kernel, row, previous, expected, offset);
}

/// Values in [0, scale], the ends among them.
std::vector<float> draw_floats(std::mt19937& random, std::size_t size, float scale) {
  std::vector<float> row(size);
  for (float& value : row) {
    const float unit = static_cast<float>(random() % (1U << 24U)) / static_cast<float>(1U << 24U);
    value = random() % 8 == 0 ? (random() % 2 == 0 ? 0.0F : scale) : unit * scale;
  }
  return row;
}

/// To the nearest integer, halves to the even one.
std::int64_t rounded(float value) {
  const double below = std::floor(static_cast<double>(value));
  const double rest = static_cast<double>(value) - below;
  const auto integer = static_cast<std::int64_t>(below);
  return rest > 0.5 || (rest == 0.5 && integer % 2 != 0) ? integer + 1 : integer;
}

template <typename Kernel>
void check_float(const Kernel& kernel, std::mt19937& random, float scale, Rows rows,
                 int partner_step, int columns, int lanes) {
  const auto wide = static_cast<std::size_t>(columns);
  const std::size_t partners = partner_count(columns, lanes);
  const auto reference_entering = draw_floats(random, wide, scale);
  const auto reference_leaving = draw_floats(random, wide, scale);
  const auto partner_entering = draw_floats(random, partners, scale);
  const auto partner_leaving = draw_floats(random, partners, scale);
  const std::size_t cells = wide * static_cast<std::size_t>(lanes);
  const std::vector<std::int32_t> previous = draw_previous(random, cells);
  std::vector<std::int32_t> expected(cells);
  const int first = first_partner(partner_step, columns);
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < lanes; ++i) {
      const auto k = static_cast<std::size_t>(first + j * partner_step + i);
      const auto column = static_cast<std::size_t>(j);
      const std::size_t cell =
          column * static_cast<std::size_t>(lanes) + static_cast<std::size_t>(i);
      const float enters = reference_entering[column] - partner_entering[k];
      const float leaves = reference_leaving[column] - partner_leaving[k];
      expected[cell] =
          modulo_32_bits(previous[cell] + (rows.entering ? rounded(enters * enters) : 0) -
                         (rows.leaving ? rounded(leaves * leaves) : 0));
    }
  }
  ColumnSsdFloat row;
  if (rows.entering) {
    row.reference_entering = reference_entering.data();
    row.partner_entering = partner_entering.data() + first;
  }
  if (rows.leaving) {
    row.reference_leaving = reference_leaving.data();
    row.partner_leaving = partner_leaving.data() + first;
  }
  row.partner_step = partner_step;
  row.columns = columns;
  row.lanes = lanes;
  expect_sums(kernel, row, previous, expected, random() % 5);
}

/// Calls check(rows, partner_step, columns, lanes) for all of them.
template <typename Check>
void for_each_shape(const Check& check) {
  for (const int lanes : kLaneCounts) {
    for (int columns = 1; columns <= 40; ++columns) {
      for (const int partner_step : {-1, 1}) {
        SCOPED_TRACE(testing::Message()
                     << lanes << " lanes, " << columns << " columns, step " << partner_step);
        // Each kind of row in turn: their code does not depend on the shape.
        check(kAllRows[(columns + lanes / kLaneMultiple) % 4], partner_step, columns, lanes);
        check(kAllRows[0], partner_step, columns, lanes);
        if (testing::Test::HasFatalFailure()) {
          return;
        }
      }
    }
  }
}

// The largest square is the last float below the limit. From half the limit on, squares are
// multiples of a quarter: ties occur.
const float kMaxScale = std::nextafter(std::sqrt(kFloatSquareLimit), 0.0F);
const float kScales[] = {kMaxScale, 255.0F, 1e-20F, 1.0F};

const auto kPairsKernel = [](const auto& row, const std::int32_t* previous, std::int32_t* sums) {
  column_ssd_row(row, previous, sums);
};

template <typename Kernel>
void sweep_pairs(const Kernel& kernel) {
  std::mt19937 random(11);
  for_each_shape([&](Rows rows, int partner_step, int columns, int lanes) {
    const Data data = columns % 2 == 0 ? Data::kRandom : Data::kWorst;
    check_pairs(kernel, random, data, rows, partner_step, columns, lanes);
  });
}

template <typename Kernel>
void sweep_floats(const Kernel& kernel) {
  std::mt19937 random(12);
  for_each_shape([&](Rows rows, int partner_step, int columns, int lanes) {
    check_float(kernel, random, kScales[columns % 4], rows, partner_step, columns, lanes);
  });
}

VANTAGE_ON_EVERY_TARGET(ColumnSsd);

TEST_P(ColumnSsd, PairsAreSumsOfSquaredDifferences) { sweep_pairs(kPairsKernel); }
TEST_P(ColumnSsd, FloatsAreSumsOfRoundedSquares) { sweep_floats(kPairsKernel); }

TEST_P(ColumnSsd, InterleavesRows) {
  std::mt19937 random(13);
  for (int count = 1; count <= 70; ++count) {
    for (int shift = 0; shift <= kMaxShift; ++shift) {
      for (const Rows rows : kAllRows) {
        const std::size_t offset = random() % 7;
        UnalignedRow<std::uint8_t> entering(rounded_up(count), offset);
        UnalignedRow<std::uint8_t> leaving(rounded_up(count), offset + 1);
        for (std::size_t k = 0; k < entering.size(); ++k) {
          entering[k] = draw_pixel(random, count % 2 == 0 ? Data::kRandom : Data::kWorst);
          leaving[k] = draw_pixel(random, count % 2 == 0 ? Data::kRandom : Data::kWorst);
        }
        std::vector<std::int32_t> expected(rounded_up(count));
        for (std::size_t k = 0; k < expected.size(); ++k) {
          const int scale = 1 << shift;
          expected[k] = (rows.entering ? entering[k] * scale : 0) +
                        (rows.leaving ? leaving[k] * scale * 65536 : 0);
        }
        GuardedRow<std::int32_t> pairs(expected.size(), offset, kSentinel);
        interleave_rows(rows.entering ? entering.data() : nullptr,
                        rows.leaving ? leaving.data() : nullptr, shift, count, pairs.data());
        // What lies behind the last pixel, up to a whole vector, is left to the kernel.
        std::vector<std::int32_t> values = pairs.values();
        values.resize(count);
        expected.resize(values.size());
        ASSERT_EQ(values, expected) << count << " pixels, shift " << shift;
        ASSERT_TRUE(pairs.intact()) << count << " pixels";
      }
    }
  }
}

}  // namespace vantage::kernels::column_ssd_test
