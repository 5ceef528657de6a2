#include "kernels/simd-inl.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernels/filled_median/filled_median.h"
#include "kernels/surface_vote/surface_vote.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using VoteTag = hn::ScalableTag<float>;
using VoteTagI = hn::ScalableTag<std::int32_t>;
using VoteVec = hn::VFromD<VoteTag>;
using VoteVecI = hn::VFromD<VoteTagI>;
constexpr std::size_t kVoteLanes = hn::MaxLanes(VoteTag());
static_assert(kMaxVoters % kVoteLanes == 0);

constexpr float kNearPx = 4;  // surfaces nearer than this weigh about the same
constexpr float kHidingWeight = 0.1F;
constexpr float kSamePx = 1;
constexpr float kLargestWeight = 1 << 20;

struct Votes {
  HWY_ALIGN std::int32_t step[kMaxVoters];    // disparities
  HWY_ALIGN std::int32_t weight[kMaxVoters];  // first as floats
  std::size_t count = 0;                      // whole vectors
  std::int32_t total = 0;
  std::int32_t min_step = 0;  // of those with weight
  std::int32_t max_step = 0;
};

HWY_INLINE VoteVecI colour_difference(const SurfaceVoters& voters, const VotePlace& place,
                                      std::size_t i) {
  const VoteTagI d;
  VoteVecI sum = hn::Zero(d);
  for (std::size_t c = 0; c < place.colour.size(); ++c) {
    sum = hn::Add(sum, hn::Abs(hn::Sub(hn::Load(d, voters.colour[c].data() + i),
                                       hn::Set(d, place.colour[c]))));
  }
  return sum;
}

// Planes that would hide what the other camera sees.
HWY_INLINE hn::Mask<VoteTag> hides(const VotePlace& place, VoteVec disparity_px) {
  const VoteTag d;
  const VoteTagI di;
  const VoteVec partner = hn::Floor(hn::Add(
      hn::Add(hn::Set(d, place.x), hn::Mul(hn::Set(d, place.seen.columns_per_px), disparity_px)),
      hn::Set(d, 0.5F)));
  const VoteVec last = hn::Set(d, static_cast<float>(place.seen.width - 1));
  const auto is_inside = hn::And(hn::Ge(partner, hn::Zero(d)), hn::Le(partner, last));
  const VoteVecI column = hn::ConvertTo(di, hn::Min(hn::Max(partner, hn::Zero(d)), last));
  const VoteVec seen_px = hn::GatherIndex(d, place.seen.disparity_px, column);
  return hn::And(is_inside, hn::Lt(seen_px, hn::Sub(disparity_px, hn::Set(d, kSamePx))));
}

HWY_INLINE void collect(const SurfaceVoters& voters, const VotePlace& place, Votes& votes) {
  const VoteTag d;
  const VoteTagI di;
  const std::int32_t* const likeness = filled_median_weights().data();
  HWY_ALIGN float weights[kMaxVoters];
  VoteVec largest = hn::Zero(d);
  votes.count = (voters.count + kVoteLanes - 1) / kVoteLanes * kVoteLanes;
  for (std::size_t i = 0; i < votes.count; i += kVoteLanes) {
    const VoteVec dx = hn::Sub(hn::Set(d, place.x), hn::Load(d, voters.x.data() + i));
    const VoteVec dy = hn::Sub(hn::Set(d, place.y), hn::Load(d, voters.y.data() + i));
    const VoteVec plane_px = hn::Add(hn::Add(hn::Load(d, voters.disparity_px.data() + i),
                                             hn::Mul(hn::Load(d, voters.slope_x.data() + i), dx)),
                                     hn::Mul(hn::Load(d, voters.slope_y.data() + i), dy));
    const VoteVec px =
        hn::Min(hn::Max(plane_px, hn::Set(d, place.min_px)), hn::Set(d, place.max_px));
    const VoteVec distance =
        hn::Add(hn::Sqrt(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy))), hn::Set(d, kNearPx));
    const VoteVec alike =
        hn::ConvertTo(d, hn::GatherIndex(di, likeness, colour_difference(voters, place, i)));
    const VoteVec full_weight =
        hn::Div(hn::Mul(hn::Load(d, voters.weight.data() + i), alike), hn::Mul(distance, distance));
    const VoteVec weight = hn::IfThenElse(
        hides(place, px), hn::Mul(full_weight, hn::Set(d, kHidingWeight)), full_weight);
    const VoteVec counted =
        hn::IfThenElseZero(hn::FirstN(d, voters.count > i ? voters.count - i : 0), weight);
    largest = hn::Max(largest, counted);
    hn::Store(counted, d, weights + i);
    hn::Store(hn::NearestInt(hn::Mul(px, hn::Set(d, static_cast<float>(kVoteStepsPerPx)))), di,
              votes.step + i);
  }
  const float largest_weight = hn::GetLane(hn::MaxOfLanes(d, largest));
  const VoteVec scale = hn::Set(d, largest_weight > 0 ? kLargestWeight / largest_weight : 0);
  VoteVecI total = hn::Zero(di);
  VoteVecI min = hn::Set(di, std::numeric_limits<std::int32_t>::max());
  VoteVecI max = hn::Set(di, std::numeric_limits<std::int32_t>::min());
  for (std::size_t i = 0; i < votes.count; i += kVoteLanes) {
    const VoteVecI weight = hn::NearestInt(hn::Mul(hn::Load(d, weights + i), scale));
    const auto counts = hn::Gt(weight, hn::Zero(di));
    const VoteVecI step = hn::Load(di, votes.step + i);
    min = hn::Min(min, hn::IfThenElse(counts, step, min));
    max = hn::Max(max, hn::IfThenElse(counts, step, max));
    total = hn::Add(total, weight);
    hn::Store(weight, di, votes.weight + i);
  }
  votes.total = hn::GetLane(hn::SumOfLanes(di, total));
  votes.min_step = hn::GetLane(hn::MinOfLanes(di, min));
  votes.max_step = hn::GetLane(hn::MaxOfLanes(di, max));
}

// The weight of votes in [min, max].
HWY_INLINE std::int32_t weight_within(const Votes& votes, std::int32_t min, std::int32_t max) {
  const VoteTagI d;
  VoteVecI sum = hn::Zero(d);
  for (std::size_t i = 0; i < votes.count; i += kVoteLanes) {
    const VoteVecI step = hn::Load(d, votes.step + i);
    const auto is_within =
        hn::And(hn::Gt(step, hn::Set(d, min - 1)), hn::Lt(step, hn::Set(d, max + 1)));
    sum = hn::Add(sum, hn::IfThenElseZero(is_within, hn::Load(d, votes.weight + i)));
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

// The smallest step such that the votes up to it have 1/part of the weight.
HWY_INLINE std::int32_t quantile(const Votes& votes, int part) {
  std::int32_t low = votes.min_step;
  std::int32_t high = votes.max_step;
  while (low < high) {
    const std::int32_t middle = low + (high - low) / 2;
    if (std::int64_t{part} * weight_within(votes, votes.min_step, middle) >= votes.total) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

VotedSurface vote_on_surface_simd(const SurfaceVoters& voters, const VotePlace& place) {
  if (voters.count == 0) {
    return {};
  }
  Votes votes;
  collect(voters, place, votes);
  if (votes.total == 0) {
    return {};
  }
  const auto px_of = [](std::int32_t step) {
    return static_cast<float>(step) / static_cast<float>(kVoteStepsPerPx);
  };
  std::int32_t step = quantile(votes, 2);
  if (std::abs(seen_at(place.seen, place.x, px_of(step)) - px_of(step)) > kSamePx) {
    step = quantile(votes, 4);
  }
  std::size_t winner = kMaxVoters;
  for (std::size_t i = 0; i < voters.count; ++i) {
    if (votes.step[i] == step && (winner == kMaxVoters || votes.weight[i] > votes.weight[winner])) {
      winner = i;
    }
  }
  const auto agreeing =
      static_cast<float>(weight_within(votes, step - kVoteStepsPerPx, step + kVoteStepsPerPx));
  return {winner, px_of(step), agreeing / static_cast<float>(votes.total)};
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(vote_on_surface_simd);

VotedSurface vote_on_surface(const SurfaceVoters& voters, const VotePlace& place) {
  return HWY_DYNAMIC_DISPATCH(vote_on_surface_simd)(voters, place);
}

float seen_at(const SeenRow& row, float x, float disparity_px) {
  const float partner = std::floor(x + row.columns_per_px * disparity_px + 0.5F);
  return partner >= 0 && partner <= static_cast<float>(row.width - 1)  // false for NaN
             ? row.disparity_px[static_cast<int>(partner)]
             : std::numeric_limits<float>::quiet_NaN();
}

}  // namespace vantage::kernels
#endif
