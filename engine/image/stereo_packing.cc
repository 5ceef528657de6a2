#include "engine/image/stereo_packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

#include "engine/error.h"

namespace vantage {
namespace {

template <typename T>
void copy_pixels(ImageView<const T> source, ImageView<T> target) {
  for (int y = 0; y < source.height(); ++y) {
    std::copy_n(source.row(y), source.width() * source.channels(), target.row(y));
  }
}

bool divides_height(StereoPacking packing) {
  return packing.layout == StereoLayout::kAboveBelow || packing.layout == StereoLayout::kRows;
}

/// The first or second image of a packed picture whose columns do not take turns.
template <typename View>
View part_of(const View& packed, StereoLayout layout, bool second) {
  const int channels = packed.channels();
  if (layout == StereoLayout::kSideBySide) {
    const int width = packed.width() / 2;
    return {packed.row(0) + (second ? width * channels : 0), width, packed.height(), channels,
            packed.stride()};
  }
  const int height = packed.height() / 2;
  if (layout == StereoLayout::kAboveBelow) {
    return {packed.row(second ? height : 0), packed.width(), height, channels, packed.stride()};
  }
  return {packed.row(second ? 1 : 0), packed.width(), height, channels, 2 * packed.stride()};
}

/// Columns `first`, first + step …
struct Columns {
  int first = 0;
  int step = 1;
};

template <typename T>
void copy_columns(ImageView<const T> source, Columns from, ImageView<T> target, Columns to,
                  int count) {
  const int channels = source.channels();
  for (int y = 0; y < source.height(); ++y) {
    for (int x = 0; x < count; ++x) {
      std::copy_n(source.row(y) + (from.first + x * from.step) * channels, channels,
                  target.row(y) + (to.first + x * to.step) * channels);
    }
  }
}

/// Clamping range of interpolated values: cubic interpolation overshoots.
template <typename T>
struct ValueRange {
  T smallest;
  T largest;
};

/// Range of the type; for floats, of the pixels.
template <typename T>
ValueRange<T> range_of(ImageView<const T> image) {
  if constexpr (!std::is_same_v<T, float>) {
    return {std::numeric_limits<T>::min(), std::numeric_limits<T>::max()};
  } else {
    ValueRange<T> range{*image.row(0), *image.row(0)};
    for (int y = 0; y < image.height(); ++y) {
      const auto [smallest, largest] =
          std::minmax_element(image.row(y), image.row(y) + image.width() * image.channels());
      range = {std::min(range.smallest, *smallest), std::max(range.largest, *largest)};
    }
    return range;
  }
}

/// Catmull-Rom interpolation a quarter of the way from `near` to `next`: the cubic one that
/// preserves ramps. `before` precedes `near`, `after` follows `next`.
template <typename T>
T at_a_quarter(T before, T near, T next, T after, ValueRange<T> range) {
  if constexpr (std::is_same_v<T, float>) {
    const float sum = -9.0F * before + 111.0F * near + 29.0F * next - 3.0F * after;
    return std::clamp(sum / 128.0F, range.smallest, range.largest);
  } else {
    const int sum = -9 * before + 111 * near + 29 * next - 3 * after;
    return static_cast<T>(std::clamp<int>((sum + 64) >> 7, range.smallest, range.largest));
  }
}

/// Computes the two full-size pixels (or rows) for each half-size one. `sources`: the half-size one
/// in the middle, with two neighbours on either side.
template <typename T>
void stretch_run(const std::array<const T*, 5>& sources, int count, ValueRange<T> range, T* first,
                 T* second) {
  const auto [s0, s1, s2, s3, s4] = sources;
  for (int i = 0; i < count; ++i) {
    first[i] = at_a_quarter(s3[i], s2[i], s1[i], s0[i], range);
    second[i] = at_a_quarter(s1[i], s2[i], s3[i], s4[i], range);
  }
}

template <typename T>
void stretch_rows(ImageView<const T> half, ImageView<T> full) {
  const ValueRange<T> range = range_of(half);
  std::array<const T*, 5> sources;
  for (int y = 0; y < half.height(); ++y) {
    for (int i = 0; i < 5; ++i) {
      sources[static_cast<std::size_t>(i)] = half.row(std::clamp(y + i - 2, 0, half.height() - 1));
    }
    stretch_run(sources, half.width() * half.channels(), range, full.row(2 * y),
                full.row(2 * y + 1));
  }
}

template <typename T>
void stretch_columns(ImageView<const T> half, ImageView<T> full) {
  const ValueRange<T> range = range_of(half);
  const int channels = half.channels();
  std::array<const T*, 5> sources;
  for (int y = 0; y < half.height(); ++y) {
    for (int x = 0; x < half.width(); ++x) {
      for (int i = 0; i < 5; ++i) {
        sources[static_cast<std::size_t>(i)] =
            half.row(y) + std::clamp(x + i - 2, 0, half.width() - 1) * channels;
      }
      T* target = full.row(y) + 2 * x * channels;
      stretch_run(sources, channels, range, target, target + channels);
    }
  }
}

template <typename T>
void unpack_half(ImageView<const T> half, StereoPacking packing, Image<T>& image) {
  const int factor = packing.half_size ? 2 : 1;
  const bool is_high = divides_height(packing);
  image.resize(half.width() * (is_high ? 1 : factor), half.height() * (is_high ? factor : 1),
               half.channels());
  if (!packing.half_size) {
    copy_pixels(half, image.view());
  } else if (is_high) {
    stretch_rows(half, image.view());
  } else {
    stretch_columns(half, image.view());
  }
}

/// Extracts the first or second image of `packed`, in full size.
void unpack_image(const Photograph& packed, StereoPacking packing, bool second, Photograph& image) {
  const bool is_high = divides_height(packing);
  const int divided = is_high ? packed.height() : packed.width();
  if (divided < 2 || divided % 2 != 0) {
    throw Error(fmt::format("packed image is {}x{}, expected an even {} that both images share",
                            packed.width(), packed.height(), is_high ? "height" : "width"));
  }
  image.origin = packed.origin;
  const auto unpack = [&]<typename T>(const Image<T>& pixels, Image<T>& result) {
    if (packing.layout == StereoLayout::kColumns) {
      result.resize(pixels.width() / 2, pixels.height(), pixels.channels());
      copy_columns<T>(pixels.view(), {second ? 1 : 0, 2}, result.view(), {}, result.width());
    } else {
      unpack_half(part_of(pixels.view(), packing.layout, second), packing, result);
    }
  };
  std::visit([&]<typename T>(const Image<T>& pixels) { unpack(pixels, pixels_of<T>(image)); },
             packed.pixels);
  image.left_out = {};
  if (!packed.left_out.empty()) {
    unpack(packed.left_out, image.left_out);
  }
}

template <typename T>
T mean_of(T a, T b) {
  if constexpr (std::is_same_v<T, float>) {
    return 0.5F * (a + b);
  } else {
    return static_cast<T>((static_cast<unsigned>(a) + b + 1U) / 2U);
  }
}

/// `part`: of the packed picture.
template <typename T>
void pack_part(const Image<T>& image, StereoPacking packing, ImageView<T> part) {
  const int channels = image.channels();
  if (!packing.half_size) {
    copy_pixels(image.view(), part);
  } else if (divides_height(packing)) {
    for (int y = 0; y < part.height(); ++y) {
      const T* upper = image.row(2 * y);
      const T* lower = image.row(std::min(2 * y + 1, image.height() - 1));
      std::transform(upper, upper + part.width() * channels, lower, part.row(y), mean_of<T>);
    }
  } else {
    for (int y = 0; y < part.height(); ++y) {
      const T* source = image.row(y);
      T* target = part.row(y);
      for (int x = 0; x < part.width(); ++x) {
        const int left = 2 * x * channels;
        const int right = std::min(2 * x + 1, image.width() - 1) * channels;
        for (int c = 0; c < channels; ++c) {
          target[x * channels + c] = mean_of(source[left + c], source[right + c]);
        }
      }
    }
  }
}

}  // namespace

const std::vector<std::pair<std::string_view, StereoPacking>>& stereo_packing_names() {
  using enum StereoLayout;
  static const std::vector<std::pair<std::string_view, StereoPacking>> kNames = {
      {"sbsl", {}},
      {"sbsr", {.right_first = true}},
      {"sbs2l", {.half_size = true}},
      {"sbs2r", {.half_size = true, .right_first = true}},
      {"abl", {.layout = kAboveBelow}},
      {"abr", {.layout = kAboveBelow, .right_first = true}},
      {"ab2l", {.layout = kAboveBelow, .half_size = true}},
      {"ab2r", {.layout = kAboveBelow, .half_size = true, .right_first = true}},
      {"tbl", {.layout = kAboveBelow}},
      {"tbr", {.layout = kAboveBelow, .right_first = true}},
      {"tb2l", {.layout = kAboveBelow, .half_size = true}},
      {"tb2r", {.layout = kAboveBelow, .half_size = true, .right_first = true}},
      {"irl", {.layout = kRows}},
      {"irr", {.layout = kRows, .right_first = true}},
      {"icl", {.layout = kColumns}},
      {"icr", {.layout = kColumns, .right_first = true}},
      {"al", {.layout = kFrames}},
      {"ar", {.layout = kFrames, .right_first = true}}};
  return kNames;
}

std::string_view to_name(StereoPacking packing) {
  for (const auto& [name, named] : stereo_packing_names()) {
    if (named == packing) {
      return name;
    }
  }
  return {};
}

void require_equal_shapes(const Photograph& left, const Photograph& right) {
  constexpr std::string_view kDepths[] = {"8-bit", "16-bit", "float"};
  const auto shape = [&](const Photograph& photograph) {
    return fmt::format("{}x{} with {} {} channel{}", photograph.width(), photograph.height(),
                       photograph.channels(), kDepths[photograph.pixels.index()],
                       photograph.channels() == 1 ? "" : "s");
  };
  if (left.pixels.index() != right.pixels.index() || left.width() != right.width() ||
      left.height() != right.height() || left.channels() != right.channels()) {
    throw Error(fmt::format("left image is {} but right image is {}, expected equal shapes",
                            shape(left), shape(right)));
  }
}

void unpack_stereo(const Photograph& packed, StereoPacking packing, Photograph& left,
                   Photograph& right) {
  unpack_image(packed, packing, packing.right_first, left);
  unpack_image(packed, packing, !packing.right_first, right);
}

void unpack_left(const Photograph& packed, StereoPacking packing, Photograph& left) {
  unpack_image(packed, packing, packing.right_first, left);
}

void pack_stereo(const Photograph& left, const Photograph& right, StereoPacking packing,
                 Photograph& packed) {
  require_equal_shapes(left, right);
  std::visit(
      [&]<typename T>(const Image<T>& left_image) {
        const auto& right_image = std::get<Image<T>>(right.pixels);
        const auto packed_side = [&](int side, bool is_divided) {
          return !is_divided ? side : 2 * (packing.half_size ? (side + 1) / 2 : side);
        };
        const bool is_high = divides_height(packing);
        Image<T>& image = pixels_of<T>(packed);
        image.resize(packed_side(left_image.width(), !is_high),
                     packed_side(left_image.height(), is_high), left_image.channels());
        for (const bool second : {false, true}) {
          const Image<T>& source = second == packing.right_first ? left_image : right_image;
          if (packing.layout == StereoLayout::kColumns) {
            copy_columns<T>(source.view(), {}, image.view(), {second ? 1 : 0, 2}, source.width());
          } else {
            pack_part(source, packing, part_of(image.view(), packing.layout, second));
          }
        }
      },
      left.pixels);
}

}  // namespace vantage
