#include "kernels/diffusion_step/diffusion_step.h"

namespace vantage::kernels {
namespace {

/// Sum of the neighbours' parts; `own`: the part of the centre is set.
float neighbours_of(const DiffusionRow& row, int x, int i, float& own) {
  const StarRow& star = row.star;
  const float left = star.left_of(x)[i];
  const float right = star.right_of(x)[i];
  const float up = star.up[x * star.up_pitch + i];
  const float down = star.down[x * star.down_pitch + i];
  if (row.weights.are_given()) {
    const StarSteps steps = StarSteps::of(row.weights, row.step, x);
    own = 1.0F - steps.sum() - row.pull;
    return (steps.left * left + steps.right * right) + (steps.up * up + steps.down * down);
  }
  own = 1.0F - 4.0F * row.step - row.pull;
  return row.step * ((left + right) + (up + down));
}

}  // namespace

void diffusion_row_ref(const DiffusionRow& row) {
  const StarRow& star = row.star;
  for (int x = 0; x < star.columns; ++x) {
    for (int i = 0; i < star.lanes; ++i) {
      float own = 0;
      const float neighbours = neighbours_of(row, x, i, own);
      float energy = own * star.centre[x * star.pitch + i] + neighbours;
      if (row.pull != 0.0F) {
        energy = energy + row.pull * star.source[x * star.lanes + i];
      }
      row.output[x * star.lanes + i] = energy;
    }
  }
}

}  // namespace vantage::kernels
