#include "engine/image/stereo_display.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace vantage {
namespace {

/// Rows: R, G and B of the anaglyph; columns: R, G, B of the left, then of the right image.
using AnaglyphMatrix = std::array<std::array<float, 6>, 3>;

// As computed by Dubois for the primaries of a screen and the filters of common glasses.
const AnaglyphMatrix& matrix_of(Anaglyph anaglyph) {
  static constexpr AnaglyphMatrix kRedCyan = {
      {{0.456100F, 0.500484F, 0.176381F, -0.0434706F, -0.0879388F, -0.00155529F},
       {-0.0400822F, -0.0378246F, -0.0157589F, 0.378476F, 0.733640F, -0.0184503F},
       {-0.0152161F, -0.0205971F, -0.00546856F, -0.0721527F, -0.112961F, 1.22640F}}};
  static constexpr AnaglyphMatrix kGreenMagenta = {
      {{-0.062F, -0.158F, -0.039F, 0.529F, 0.705F, 0.024F},
       {0.284F, 0.668F, 0.143F, -0.016F, -0.015F, -0.065F},
       {-0.015F, -0.027F, 0.021F, 0.009F, 0.075F, 0.937F}}};
  static constexpr AnaglyphMatrix kYellowBlue = {
      {{1.062F, -0.205F, 0.299F, -0.016F, -0.123F, -0.017F},
       {-0.026F, 0.908F, 0.068F, 0.006F, 0.062F, -0.017F},
       {-0.038F, -0.173F, 0.022F, 0.094F, 0.185F, 0.911F}}};
  switch (anaglyph) {
    case Anaglyph::kRedCyan:
      return kRedCyan;
    case Anaglyph::kGreenMagenta:
      return kGreenMagenta;
    case Anaglyph::kYellowBlue:
      break;
  }
  return kYellowBlue;
}

template <typename T>
T to_value(float value) {
  if constexpr (std::is_integral_v<T>) {
    const auto largest = static_cast<float>(std::numeric_limits<T>::max());
    return static_cast<T>(std::floor(std::clamp(value, 0.0F, largest) + 0.5F));
  } else {
    return std::clamp(value, 0.0F, 1.0F);
  }
}

template <typename T>
void make_anaglyph(const Image<T>& left, const Image<T>& right, const AnaglyphMatrix& matrix,
                   Image<T>& shown) {
  const int channels = left.channels();
  const bool is_grey = channels == 1;
  shown.resize(left.width(), left.height(), is_grey ? 3 : channels);
  for (int y = 0; y < left.height(); ++y) {
    for (int x = 0; x < left.width(); ++x) {
      std::array<float, 6> values;
      for (int c = 0; c < 3; ++c) {
        values[static_cast<std::size_t>(c)] = static_cast<float>(left.at(x, y, is_grey ? 0 : c));
        values[static_cast<std::size_t>(c + 3)] =
            static_cast<float>(right.at(x, y, is_grey ? 0 : c));
      }
      for (int c = 0; c < 3; ++c) {
        float sum = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
          sum += matrix[static_cast<std::size_t>(c)][i] * values[i];
        }
        shown.at(x, y, c) = to_value<T>(sum);
      }
      if (channels == 4) {
        shown.at(x, y, 3) = to_value<T>(
            (static_cast<float>(left.at(x, y, 3)) + static_cast<float>(right.at(x, y, 3))) / 2);
      }
    }
  }
}

}  // namespace

const std::vector<std::pair<std::string_view, StereoDisplay>>& stereo_display_names() {
  static const auto kNames = [] {
    std::vector<std::pair<std::string_view, StereoDisplay>> names;
    for (const auto& [name, packing] : stereo_packing_names()) {
      if (packing.layout != StereoLayout::kFrames) {
        names.emplace_back(name, packing);
      }
    }
    names.emplace_back("arcd", Anaglyph::kRedCyan);
    names.emplace_back("agmd", Anaglyph::kGreenMagenta);
    names.emplace_back("aybd", Anaglyph::kYellowBlue);
    return names;
  }();
  return kNames;
}

void show_stereo(const Photograph& left, const Photograph& right, const StereoDisplay& display,
                 Photograph& shown) {
  if (const auto* packing = std::get_if<StereoPacking>(&display)) {
    pack_stereo(left, right, *packing, shown);
    return;
  }
  require_equal_shapes(left, right);
  std::visit(
      [&]<typename T>(const Image<T>& left_image) {
        make_anaglyph(left_image, std::get<Image<T>>(right.pixels),
                      matrix_of(std::get<Anaglyph>(display)), pixels_of<T>(shown));
      },
      left.pixels);
}

}  // namespace vantage
