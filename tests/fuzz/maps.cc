// Maps, which `synth`, `reproject` and `eval` read.
#include <cmath>

#include "engine/io/maps/map_io.h"
#include "tests/fuzz/target.h"

namespace vantage::fuzz {
namespace {

void require_no_infinity(const Image<float>& map) {
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      require(!std::isinf(map.at(x, y)), "a number or NaN");
    }
  }
}

/// The last byte chooses among those who read maps.
void read_map(Bytes bytes) {
  const std::filesystem::path file = file_of(bytes);
  std::vector<Remark> remarks;
  switch (bytes.empty() ? 0 : bytes.back() % 4) {
    case 0:
      require_no_infinity(read_disparity(file, 0, &remarks));
      break;
    case 1:
      require_no_infinity(read_disparity(file, 16, &remarks));
      break;
    case 2:
      require_no_infinity(read_depth(file, 0, &remarks));
      break;
    default:
      require_no_infinity(read_float_image(file));
      break;
  }
}

const Registration kMap("map", read_map);

}  // namespace
}  // namespace vantage::fuzz
