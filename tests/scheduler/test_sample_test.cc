#include "tests/test_sample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <tuple>

namespace vantage::test::test_sample_test {

/// Sets or clears an environment variable while it exists.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    const char* const before = std::getenv(name);
    had_value_ = before != nullptr;
    before_ = had_value_ ? before : "";
    set(value);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  ~Variable() { set(had_value_ ? before_.c_str() : nullptr); }

 private:
  void set(const char* value) const {
    if (value == nullptr) {
      ::unsetenv(name_);
    } else {
      ::setenv(name_, value, 1);
    }
  }
  const char* name_;
  bool had_value_;
  std::string before_;
};

using Pair = std::tuple<std::size_t, int, std::size_t, int>;

std::set<Pair> pairs_of(const std::vector<SampleRow>& rows) {
  std::set<Pair> pairs;
  for (const SampleRow& row : rows) {
    for (std::size_t j = 0; j < row.size(); ++j) {
      for (std::size_t k = j + 1; k < row.size(); ++k) {
        pairs.emplace(j, row[j], k, row[k]);
      }
    }
  }
  return pairs;
}

TEST(TestSample, EveryPairOfValuesOccursInFewRows) {
  struct Case {
    std::vector<int> sizes;
    std::size_t max_rows;
  };
  for (const Case& c :
       {Case{{3, 3}, 9}, Case{{1, 1, 1}, 1}, Case{{2, 2, 2, 2}, 8}, Case{{8, 8, 6}, 80},
        Case{{27, 2, 3, 3, 5, 5, 4, 4}, 200}, Case{{11, 6, 4, 6, 4, 22}, 300}}) {
    for (const std::uint32_t seed : {1U, 2U, 77U}) {
      const std::vector<SampleRow> rows = covering_rows(c.sizes, seed);
      EXPECT_LE(rows.size(), c.max_rows) << c.sizes.size() << " dimensions, seed " << seed;
      std::size_t pairs = 0;
      for (std::size_t j = 0; j < c.sizes.size(); ++j) {
        for (std::size_t k = j + 1; k < c.sizes.size(); ++k) {
          pairs += static_cast<std::size_t>(c.sizes[j] * c.sizes[k]);
        }
      }
      EXPECT_EQ(pairs_of(rows).size(), pairs) << c.sizes.size() << " dimensions, seed " << seed;
      for (const SampleRow& row : rows) {
        for (std::size_t k = 0; k < row.size(); ++k) {
          ASSERT_GE(row[k], 0);
          ASSERT_LT(row[k], c.sizes[k]);
        }
      }
    }
  }
}

TEST(TestSample, PairsThatCanBeHadOccurWhereRowsAreRefused) {
  const std::vector<int> sizes = {7, 5, 4, 3};
  // One pair cannot be had at all, others in few rows only.
  const RowFilter filter = [](const SampleRow& row) {
    return !(row[1] == 0 && row[2] == 0) && !(row[1] < 2 && row[3] > 0 && row[2] < 2);
  };
  const std::vector<SampleRow> rows = covering_rows(sizes, 5, filter);
  EXPECT_LT(rows.size(), all_rows(sizes).size() / 4);
  EXPECT_EQ(pairs_of(rows), pairs_of(all_rows(sizes, filter)));
  EXPECT_TRUE(std::ranges::all_of(rows, filter));
}

TEST(TestSample, OneDimensionIsTakenWhole) {
  EXPECT_EQ(covering_rows({4}, 1), (std::vector<SampleRow>{{0}, {1}, {2}, {3}}));
}

TEST(TestSample, AllRowsAreTheProduct) {
  EXPECT_EQ(all_rows({2, 3}),
            (std::vector<SampleRow>{{0, 0}, {0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}}));
}

TEST(TestSample, TheSeedDecides) {
  const std::vector<int> sizes = {5, 4, 3, 6};
  EXPECT_EQ(covering_rows(sizes, 1), covering_rows(sizes, 1));
  EXPECT_NE(covering_rows(sizes, 1), covering_rows(sizes, 2));
}

TEST(TestSample, EnvironmentChoosesSeedAndEverything) {
  const std::vector<int> sizes = {5, 4, 3};
  {
    const Variable all("VANTAGE_TEST_ALL", nullptr);
    const Variable seed("VANTAGE_TEST_SEED", nullptr);
    EXPECT_EQ(sampled_rows(sizes), covering_rows(sizes, 1));
    EXPECT_EQ(sample_name(), "VANTAGE_TEST_SEED=1");
  }
  {
    const Variable all("VANTAGE_TEST_ALL", "0");
    const Variable seed("VANTAGE_TEST_SEED", "12");
    EXPECT_EQ(sampled_rows(sizes), covering_rows(sizes, 12));
    EXPECT_EQ(sample_name(), "VANTAGE_TEST_SEED=12");
  }
  const Variable all("VANTAGE_TEST_ALL", "1");
  EXPECT_EQ(sampled_rows(sizes), all_rows(sizes));
  EXPECT_EQ(sample_name(), "VANTAGE_TEST_ALL=1");
}

TEST(TestSample, RowsOfAnInstanceBeginWithIt) {
  EXPECT_EQ(rows_of({{0, 1}, {1, 0}, {0, 2}}, 0), (std::vector<SampleRow>{{0, 1}, {0, 2}}));
}

}  // namespace vantage::test::test_sample_test
