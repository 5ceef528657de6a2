#include "engine/combinations/combinations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "engine/combinations/combination_texts.h"
#include "engine/error.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/options/method_names.h"

namespace vantage {
namespace combinations_test {

using testing::Contains;
using testing::Not;

/// Gives the option a value for which the condition holds.
void satisfy(const Condition& condition, OptionValues& values) {
  const double step = std::isinf(condition.number) ? 0 : condition.number;
  switch (condition.test) {
    case Condition::Test::kGiven:
    case Condition::Test::kSet:
      values.set(condition.option, "some", true);
      return;
    case Condition::Test::kIs:
      condition.word.empty() ? values.set(condition.option, condition.number, true)
                             : values.set(condition.option, condition.word, true);
      return;
    case Condition::Test::kIsNot:
      condition.word.empty() ? values.set(condition.option, condition.number + 1, true)
                             : values.set(condition.option, "another", true);
      return;
    case Condition::Test::kAbove:
      values.set(condition.option, step + 1, true);
      return;
    case Condition::Test::kBelow:
      values.set(condition.option, step / 2, true);
      return;
  }
}

std::string name_of(const Condition& condition) {
  return condition.option.substr(0, condition.option.find(' '));
}

TEST(Combinations, EveryRowIsRefusedInALineThatNamesOneOfItsSides) {
  for (const Combination& row : combinations()) {
    std::vector<Condition> cases = row.with;
    if (!row.only_with.empty()) {
      cases.push_back(row.option);
    }
    for (const Condition& with : cases) {
      OptionValues values;
      if (row.only_with.empty()) {
        values.set("left", "given");  // several images go with it only
      }
      satisfy(with, values);
      satisfy(row.option, values);
      ASSERT_NE(row.case_of(values), nullptr) << row.option.text() << " with " << with.text();
      if (row.message.empty()) {
        EXPECT_TRUE(row.gives_way_to);
        continue;
      }
      try {
        refuse_combinations(row.scope, values);
        FAIL() << row.option.text() << " with " << with.text();
      } catch (const UsageError& error) {
        const std::string text = error.what();
        EXPECT_EQ(text.find('\n'), std::string::npos);
        EXPECT_EQ(text.find('{'), std::string::npos) << text;
        EXPECT_TRUE(text.find(name_of(row.option)) != std::string::npos ||
                    text.find(name_of(with)) != std::string::npos || row.option.option == "more")
            << text;
      }
    }
  }
}

TEST(Combinations, NothingIsRefusedOfOptionsThatAreNotGiven) {
  OptionValues values;
  for (const Combination& row : combinations()) {
    values.set_absent(row.option.option, false);
    for (const Condition& with : row.with) {
      values.set_absent(with.option, false);
    }
  }
  for (const Combination& row : combinations()) {
    EXPECT_EQ(row.case_of(values), nullptr) << row.option.text();
  }
}

TEST(Combinations, PresetsGiveWayToWhatAUserSets) {
  std::vector<MatchOptions> choices(8);
  choices[0].disparities_y = DisparityRange{-1, 1};
  choices[1].parameters.selection = Selection::kScanline;
  choices[2].parameters.selection = Selection::kSymmetric;
  choices[3].parameters.prior = Prior::kQuadratic;
  choices[4].parameters.prior_smoothing = PriorSmoothing::kSum;
  choices[5].parameters.levels = 1;
  choices[6].parameters.colour = ColourUse::kChannels;
  choices[7].parameters.cost = MatchCost::kSquared;
  for (const auto& [name, preset] : names_of(MatchPreset{})) {
    for (std::size_t i = 0; i < choices.size(); ++i) {
      MatchOptions options = choices[i];
      options.preset = preset;
      options.disparities = {0, 15};
      EXPECT_NO_THROW(options.validate()) << name << ", choice " << i;
    }
  }
}

TEST(Combinations, HelpNamesTheOtherSideOfOptionsThatACommandHas) {
  const auto all = [](std::string_view) { return true; };
  EXPECT_THAT(not_with("edge-snapping", all), Contains("--disparities-y"));
  EXPECT_THAT(not_with("disparities-y", all), Contains("--edge-snapping"));
  EXPECT_THAT(not_with("selection", all), Contains("--disparities-y"));
  const auto others = [](std::string_view option) { return option != "disparities-y"; };
  EXPECT_THAT(not_with("edge-snapping", others), Not(Contains("--disparities-y")));
}

}  // namespace combinations_test
}  // namespace vantage
