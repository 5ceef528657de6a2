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

/// Rows: R, G and B of the anaglyph; columns: R, G, B of the left, then of the right image. As
/// computed by Dubois for the primaries of a screen and the filters of common glasses.
constexpr std::array<std::array<float, 6>, 3> kAnaglyph = {
    {{0.456100F, 0.500484F, 0.176381F, -0.0434706F, -0.0879388F, -0.00155529F},
     {-0.0400822F, -0.0378246F, -0.0157589F, 0.378476F, 0.733640F, -0.0184503F},
     {-0.0152161F, -0.0205971F, -0.00546856F, -0.0721527F, -0.112961F, 1.22640F}}};

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
void make_anaglyph(const Image<T>& left, const Image<T>& right, Image<T>& shown) {
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
          sum += kAnaglyph[static_cast<std::size_t>(c)][i] * values[i];
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

template <typename T>
void interleave(const Image<T>& left, const Image<T>& right, InterleavedStereo order,
                Image<T>& shown) {
  const Image<T>& first = order.right_first ? right : left;
  const Image<T>& second = order.right_first ? left : right;
  const int channels = left.channels();
  const auto values = static_cast<std::size_t>(left.width() * channels);
  shown.resize(left.width(), 2 * left.height(), channels);
  for (int y = 0; y < left.height(); ++y) {
    std::copy_n(first.row(y), values, shown.row(2 * y));
    std::copy_n(second.row(y), values, shown.row(2 * y + 1));
  }
}

}  // namespace

const std::vector<std::pair<std::string_view, StereoDisplay>>& stereo_display_names() {
  static const auto kNames = [] {
    std::vector<std::pair<std::string_view, StereoDisplay>> names;
    for (const auto& [name, packing] : stereo_packing_names()) {
      names.emplace_back(name, packing);
    }
    names.emplace_back("arcd", Anaglyph{});
    names.emplace_back("irl", InterleavedStereo{});
    names.emplace_back("irr", InterleavedStereo{.right_first = true});
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
        Image<T>& result = pixels_of<T>(shown);
        const auto& right_image = std::get<Image<T>>(right.pixels);
        if (const auto* order = std::get_if<InterleavedStereo>(&display)) {
          interleave(left_image, right_image, *order, result);
        } else {
          make_anaglyph(left_image, right_image, result);
        }
      },
      left.pixels);
}

}  // namespace vantage
