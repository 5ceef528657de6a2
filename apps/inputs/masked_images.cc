#include "apps/inputs/masked_images.h"

#include <array>
#include <cstddef>

#include "engine/io/images/photograph_io.h"

namespace vantage::apps {

void leave_out_masked(const SceneMaskOptions& options, Photograph& left, Photograph& right) {
  std::array<Photograph, 2> masks;
  std::array<const Photograph*, 2> files = {};
  for (const std::size_t i : {0, 1}) {
    if (!options.file(i).empty()) {
      masks[i] = read_photograph(options.file(i));
      files[i] = &masks[i];
    }
  }
  leave_out_of_pair(options, files, nullptr, left, right);
}

}  // namespace vantage::apps
