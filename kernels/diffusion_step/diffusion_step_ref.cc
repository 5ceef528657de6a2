#include "kernels/diffusion_step/diffusion_step.h"

namespace vantage::kernels {

void diffusion_row_ref(const DiffusionRow& row) {
  const StarRow& star = row.star;
  const float own = 1.0F - 4.0F * row.step - row.pull;
  for (int x = 0; x < star.columns; ++x) {
    for (int i = 0; i < star.lanes; ++i) {
      const float neighbours =
          (star.left_of(x)[i] + star.right_of(x)[i]) +
          (star.up[x * star.up_pitch + i] + star.down[x * star.down_pitch + i]);
      float energy = own * star.centre[x * star.pitch + i] + row.step * neighbours;
      if (row.pull != 0.0F) {
        energy = energy + row.pull * star.source[x * star.lanes + i];
      }
      row.output[x * star.lanes + i] = energy;
    }
  }
}

}  // namespace vantage::kernels
