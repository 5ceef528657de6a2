#include "kernels/simd-inl.h"

#include "kernels/diffusion_step/diffusion_step.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

template <bool kPull, bool kWeighted>
HWY_INLINE void diffusion_columns(const DiffusionRow& row) {
  const hn::ScalableTag<float> df;
  const int vector = static_cast<int>(hn::Lanes(df));
  const StarRow& star = row.star;
  const int lanes = star.lanes;
  auto own = hn::Set(df, 1.0F - 4.0F * row.step - row.pull);
  const auto step = hn::Set(df, row.step);
  const auto pull = hn::Set(df, row.pull);
  const float* centre = star.centre;
  const float* left = star.left_of_first;
  const float* up = star.up;
  const float* down = star.down;
  const float* source = star.source;
  float* output = row.output;
  for (int x = 0; x < star.columns; ++x) {
    const float* right = x + 1 < star.columns ? centre + star.pitch : star.right_of_last;
    StarSteps steps{};
    if constexpr (kWeighted) {
      steps = StarSteps::of(row.weights, row.step, x);
      own = hn::Set(df, 1.0F - steps.sum() - row.pull);
    }
#pragma GCC unroll 4
    for (int lane = 0; lane < lanes; lane += vector) {
      const auto load = [&](const float* cells) HWY_ATTR { return hn::Load(df, cells + lane); };
      const auto part = [&](float weight, const float* cells)
                            HWY_ATTR { return hn::Mul(hn::Set(df, weight), load(cells)); };
      auto neighbours = hn::Zero(df);
      if constexpr (kWeighted) {
        neighbours = hn::Add(hn::Add(part(steps.left, left), part(steps.right, right)),
                             hn::Add(part(steps.up, up), part(steps.down, down)));
      } else {
        neighbours =
            hn::Mul(step, hn::Add(hn::Add(load(left), load(right)), hn::Add(load(up), load(down))));
      }
      auto energy = hn::Add(hn::Mul(own, load(centre)), neighbours);
      if constexpr (kPull) {
        energy = hn::Add(energy, hn::Mul(pull, load(source)));
      }
      hn::Store(energy, df, output + lane);
    }
    left = centre;
    centre += star.pitch;
    up += star.up_pitch;
    down += star.down_pitch;
    if constexpr (kPull) {
      source += lanes;
    }
    output += lanes;
  }
}

template <bool kPull>
HWY_INLINE void diffusion_row_with(const DiffusionRow& row) {
  if (row.weights.are_given()) {
    diffusion_columns<kPull, true>(row);
  } else {
    diffusion_columns<kPull, false>(row);
  }
}

void diffusion_row_simd(const DiffusionRow& row) {
  if (row.pull != 0.0F) {
    diffusion_row_with<true>(row);
  } else {
    diffusion_row_with<false>(row);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(diffusion_row_simd);

void diffusion_row(const DiffusionRow& row) { HWY_DYNAMIC_DISPATCH(diffusion_row_simd)(row); }

}  // namespace vantage::kernels
#endif
