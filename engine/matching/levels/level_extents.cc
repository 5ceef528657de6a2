#include "engine/matching/levels/level_extents.h"

namespace vantage {

std::vector<scheduler::Extent> level_extents(scheduler::Extent extent, int levels) {
  std::vector<scheduler::Extent> extents = {extent};
  while (static_cast<int>(extents.size()) < levels) {
    const scheduler::Extent next = coarser_extent(extents.back());
    if (next.columns <= 1 && next.rows <= 1) {
      break;
    }
    extents.push_back(next);
  }
  return extents;
}

}  // namespace vantage
