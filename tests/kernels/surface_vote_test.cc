#include "kernels/surface_vote/surface_vote.h"

#include <map>

#include "kernels/filled_median/filled_median.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels::surface_vote_test {

constexpr int kWidth = 120;

/// Surfaces on a grid around (40, 40), of a wall, a board and noise.
SurfaceVoters random_voters(std::size_t count, std::mt19937& random) {
  const auto number = [&](int below) { return static_cast<float>(random() % below); };
  SurfaceVoters voters;
  voters.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    voters.x[i] = number(80) + 0.5F;
    voters.y[i] = number(80) + 0.5F;
    voters.disparity_px[i] = random() % 3 == 0 ? number(90) / 3 : random() % 2 == 0 ? 8 : 21.3F;
    voters.slope_x[i] = (number(21) - 10) / 100;
    voters.slope_y[i] = (number(21) - 10) / 150;
    voters.weight[i] = number(17);
    for (auto& channel : voters.colour) {
      channel[i] = static_cast<std::int32_t>(100 + random() % 60);
    }
  }
  return voters;
}

struct Vote {
  std::int64_t weight = 0;
  int step = 0;
};

std::vector<Vote> votes_of(const SurfaceVoters& voters, const VotePlace& place) {
  std::vector<float> weights;
  std::vector<Vote> votes;
  for (std::size_t i = 0; i < voters.count; ++i) {
    const float dx = place.x - voters.x[i];
    const float dy = place.y - voters.y[i];
    const float px = std::clamp(voters.at(i, place.x, place.y), place.min_px, place.max_px);
    std::size_t difference = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      difference += static_cast<std::size_t>(std::abs(place.colour[c] - voters.colour[c][i]));
    }
    const float distance = std::sqrt(dx * dx + dy * dy) + 4;
    float weight = voters.weight[i] * static_cast<float>(filled_median_weights()[difference]) /
                   (distance * distance);
    const float partner = std::floor(place.x + place.seen.columns_per_px * px + 0.5F);
    if (partner >= 0 && partner < static_cast<float>(place.seen.width) &&
        place.seen.disparity_px[static_cast<int>(partner)] < px - 1) {
      weight *= 0.1F;
    }
    weights.push_back(weight);
    votes.push_back({0, static_cast<int>(std::nearbyint(px * kVoteStepsPerPx))});
  }
  const float largest = weights.empty() ? 0 : *std::max_element(weights.begin(), weights.end());
  for (std::size_t i = 0; i < votes.size() && largest > 0; ++i) {
    votes[i].weight = std::lround(std::nearbyint(weights[i] * (float{1 << 20} / largest)));
  }
  return votes;
}

/// The contract, by sorting.
VotedSurface expected_of(const SurfaceVoters& voters, const VotePlace& place) {
  const std::vector<Vote> votes = votes_of(voters, place);
  std::map<int, std::int64_t> weight_at;
  std::int64_t total = 0;
  for (const Vote& vote : votes) {
    weight_at[vote.step] += vote.weight;
    total += vote.weight;
  }
  if (total == 0) {
    return {};
  }
  const auto quantile = [&](int part) {
    std::int64_t sum = 0;
    for (const auto& [step, weight] : weight_at) {
      sum += weight;
      if (weight > 0 && part * sum >= total) {
        return step;
      }
    }
    return 0;
  };
  int step = quantile(2);
  const float median_px = static_cast<float>(step) / kVoteStepsPerPx;
  if (std::abs(seen_at(place.seen, place.x, median_px) - median_px) > 1) {
    step = quantile(4);
  }
  VotedSurface result;
  std::int64_t agreeing = 0;
  for (std::size_t i = 0; i < votes.size(); ++i) {
    if (votes[i].step == step &&
        (result.voter == kMaxVoters || votes[i].weight > votes[result.voter].weight)) {
      result.voter = i;
    }
    agreeing += std::abs(votes[i].step - step) <= kVoteStepsPerPx ? votes[i].weight : 0;
  }
  result.disparity_px = static_cast<float>(step) / kVoteStepsPerPx;
  result.agreement = static_cast<float>(agreeing) / static_cast<float>(total);
  return result;
}

TEST(SurfaceVote, EqualsItsDefinitionOnEveryTarget) {
  std::mt19937 random(12);
  int quartiles = 0;
  for (const std::size_t count : {0, 1, 2, 7, 16, 17, 33, 81, 96}) {
    for (int trial = 0; trial < 40; ++trial) {
      const SurfaceVoters voters = random_voters(count, random);
      UnalignedRow<float> seen_px(kWidth, 1);
      for (int x = 0; x < kWidth; ++x) {
        seen_px.data()[x] = random() % 9 == 0 ? std::numeric_limits<float>::quiet_NaN()
                            : x % 40 < 20     ? 8
                                              : 21;
      }
      const VotePlace place{.x = 30 + static_cast<float>(random() % 80) / 4,
                            .y = 40.25F,
                            .colour = {130, 120, 110},
                            .seen = {.disparity_px = seen_px.data(),
                                     .width = kWidth,
                                     .columns_per_px = trial % 2 == 0 ? -1.0F : 0.5F},
                            .min_px = 0,
                            .max_px = 28};
      const VotedSurface expected = expected_of(voters, place);
      quartiles += expected.voter != kMaxVoters &&
                   expected.disparity_px + 1 < seen_at(place.seen, place.x, expected.disparity_px);
      for_each_target([&] {
        const VotedSurface voted = vote_on_surface(voters, place);
        EXPECT_EQ(voted.voter, expected.voter);
        EXPECT_EQ(voted.disparity_px, expected.disparity_px);
        EXPECT_EQ(voted.agreement, expected.agreement);
      });
    }
  }
  EXPECT_GT(quartiles, 20);
}

TEST(SurfaceVote, NothingIsSeenOutsideTheOtherImage) {
  const std::vector<float> px = {5, 6, 7};
  const SeenRow row{.disparity_px = px.data(), .width = 3, .columns_per_px = -1};
  EXPECT_EQ(seen_at(row, 4, 2.5F), 7);
  EXPECT_EQ(seen_at(row, 4, 4.5F), 5);
  for (const float outside : {1.0F, 4.75F, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_TRUE(std::isnan(seen_at(row, 4, outside))) << outside;
  }
}

}  // namespace vantage::kernels::surface_vote_test
