#include <algorithm>
#include <limits>

#include "kernels/rgb_row/rgb_row.h"

namespace vantage::kernels {
namespace {

constexpr float kNeutral = 128 * 256;

template <typename T>
T stored(float level) {
  constexpr float kWhite = std::numeric_limits<T>::max();
  return static_cast<T>(static_cast<int>(std::min(std::max(level, 0.0F), kWhite) + 0.5F));
}

template <typename T>
void convert(const LumaChromaRow& row, const ColourFactors& factors, T* rgb) {
  for (int x = 0; x < row.width; ++x) {
    const float grey = (static_cast<float>(row.luma[x]) - factors.black) * factors.grey;
    const float blue = static_cast<float>(row.chroma_blue[x]) - kNeutral;
    const float red = static_cast<float>(row.chroma_red[x]) - kNeutral;
    rgb[3 * x] = stored<T>(grey + factors.red_of_red * red);
    rgb[3 * x + 1] = stored<T>(grey - factors.green_of_red * red - factors.green_of_blue * blue);
    rgb[3 * x + 2] = stored<T>(grey + factors.blue_of_blue * blue);
  }
}

}  // namespace

void rgb_row_ref(const LumaChromaRow& row, const ColourFactors& factors, std::uint8_t* rgb) {
  convert(row, factors, rgb);
}

void rgb_row_ref(const LumaChromaRow& row, const ColourFactors& factors, std::uint16_t* rgb) {
  convert(row, factors, rgb);
}

}  // namespace vantage::kernels
