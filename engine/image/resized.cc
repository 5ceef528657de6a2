#include "engine/image/resized.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace vantage {
namespace {

/// Pixels of the given image per pixel of the result.
double step_of(int given, int wanted) { return 1 / (static_cast<double>(wanted) / given); }

/// To the nearest, a half to the even one.
template <typename T>
T rounded(float value) {
  if constexpr (std::is_floating_point_v<T>) {
    return value;
  } else {
    constexpr float kWhole = 0x1.8p23F;  // beside it, only integers are floats
    return static_cast<T>((value + kWhole) - kWhole);
  }
}

/// A part of a mean: `weight` of the pixel at `source` for the one at `target`.
struct Share {
  int source;
  int target;
  float weight;
};

/// For one axis: how much each of the `given` pixels adds to each of the `wanted` ones, sorted by
/// target.
std::vector<Share> shares_of(int given, int wanted) {
  constexpr double kNothing = 1e-3;
  const double step = step_of(given, wanted);
  std::vector<Share> shares;
  for (int target = 0; target < wanted; ++target) {
    const double begin = target * step;
    const double end = begin + step;
    const double covered = std::min(step, given - begin);
    const int end_whole = std::min(static_cast<int>(std::floor(end)), given - 1);
    const int first_whole = std::min(static_cast<int>(std::ceil(begin)), end_whole);
    if (first_whole - begin > kNothing) {
      shares.push_back(
          {first_whole - 1, target, static_cast<float>((first_whole - begin) / covered)});
    }
    for (int source = first_whole; source < end_whole; ++source) {
      shares.push_back({source, target, static_cast<float>(1 / covered)});
    }
    if (end - end_whole > kNothing) {
      const double rest = std::min({end - end_whole, 1.0, covered});
      shares.push_back({end_whole, target, static_cast<float>(rest / covered)});
    }
  }
  return shares;
}

template <typename T>
void reduce_by_shares(ImageView<const T> image, Image<T>& result) {
  const int channels = image.channels();
  const std::vector<Share> along = shares_of(image.width(), result.width());
  const auto values = static_cast<std::size_t>(result.width() * channels);
  std::vector<float> row(values);
  std::vector<float> sums(values);
  int target = 0;
  const auto finish = [&] {
    std::transform(sums.begin(), sums.end(), result.row(target), rounded<T>);
    std::fill(sums.begin(), sums.end(), 0.0F);
  };
  for (const Share& down : shares_of(image.height(), result.height())) {
    std::fill(row.begin(), row.end(), 0.0F);
    const T* const source = image.row(down.source);
    for (const Share& share : along) {
      for (int c = 0; c < channels; ++c) {
        row[static_cast<std::size_t>(share.target * channels + c)] +=
            static_cast<float>(source[share.source * channels + c]) * share.weight;
      }
    }
    if (down.target != target) {
      finish();
      target = down.target;
    }
    for (std::size_t i = 0; i < values; ++i) {
      sums[i] += down.weight * row[i];
    }
  }
  finish();
}

/// By whole pixels: `across` columns and `down` rows for each.
template <typename T>
void reduce_by_blocks(ImageView<const T> image, int across, int down, Image<T>& result) {
  const int channels = image.channels();
  std::vector<std::size_t> block;  // values from the first to each pixel
  for (int i = 0; i < across * down; ++i) {
    block.push_back(image.stride() * static_cast<std::size_t>(i / across) +
                    static_cast<std::size_t>(i % across * channels));
  }
  const float scale = 1 / static_cast<float>(block.size());
  const bool is_of_four = across == 2 && down == 2;
  const bool rounds_up = !std::is_floating_point_v<T> && is_of_four;  // a half
  const bool by_rows = std::is_floating_point_v<T> && is_of_four && channels != 3;
  const auto mean = [&](const T* first) {
    const auto value = [&](std::size_t pixel) { return static_cast<float>(first[block[pixel]]); };
    if (by_rows) {
      return rounded<T>(((value(0) + value(1)) + (value(2) + value(3))) * scale);
    }
    float sum = 0;
    std::size_t i = 0;
    for (; i + 4 <= block.size(); i += 4) {
      sum += value(i) + value(i + 1) + value(i + 2) + value(i + 3);
    }
    for (; i < block.size(); ++i) {
      sum += value(i);
    }
    return rounds_up ? static_cast<T>((static_cast<int>(sum) + 2) / 4) : rounded<T>(sum * scale);
  };
  for (int y = 0; y < result.height(); ++y) {
    T* target = result.row(y);
    for (int x = 0; x < result.width(); ++x) {
      const T* const first = image.row(y * down) + x * across * channels;
      target = std::transform(first, first + channels, target,
                              [&](const T& value) { return mean(&value); });
    }
  }
}

/// Where a pixel lies between two of the given ones.
struct Between {
  int before;
  int after;
  float weight_before;
  float weight_after;
};

std::vector<Between> places_between(int given, int wanted, bool ends_exactly) {
  const double step = step_of(given, wanted);
  std::vector<Between> places;
  for (int i = 0; i < wanted; ++i) {
    const auto position = static_cast<float>((i + 0.5) * step - 0.5);
    const int before = static_cast<int>(std::floor(position));
    const float part = position - static_cast<float>(before);
    if (ends_exactly && (before < 0 || before >= given - 1)) {
      const int end = std::clamp(before, 0, given - 1);
      places.push_back({end, end, 1, 0});
      continue;
    }
    places.push_back(
        {std::clamp(before, 0, given - 1), std::clamp(before + 1, 0, given - 1), 1 - part, part});
  }
  return places;
}

}  // namespace

template <typename T>
Image<T> reduced_by_area(ImageView<const T> image, int width, int height) {
  Image<T> result(width, height, image.channels());
  if (image.width() % width == 0 && image.height() % height == 0) {
    reduce_by_blocks(image, image.width() / width, image.height() / height, result);
  } else {
    reduce_by_shares(image, result);
  }
  return result;
}

template Image<std::uint8_t> reduced_by_area(ImageView<const std::uint8_t>, int, int);
template Image<std::uint16_t> reduced_by_area(ImageView<const std::uint16_t>, int, int);
template Image<float> reduced_by_area(ImageView<const float>, int, int);

template <typename T>
Image<T> resized_to_nearest(ImageView<const T> image, int width, int height) {
  const auto nearest = [](int at, double step, int given) {
    return std::min(static_cast<int>(std::floor(at * step)), given - 1);
  };
  const double across = step_of(image.width(), width);
  const double down = step_of(image.height(), height);
  std::vector<int> columns;
  for (int x = 0; x < width; ++x) {
    columns.push_back(nearest(x, across, image.width()));
  }
  Image<T> result(width, height, image.channels());
  for (int y = 0; y < height; ++y) {
    const T* const source = image.row(nearest(y, down, image.height()));
    T* target = result.row(y);
    for (const int column : columns) {
      target = std::copy_n(source + column * image.channels(), image.channels(), target);
    }
  }
  return result;
}

template Image<std::uint8_t> resized_to_nearest(ImageView<const std::uint8_t>, int, int);
template Image<float> resized_to_nearest(ImageView<const float>, int, int);

Image<float> resized_linearly(ImageView<const float> image, int width, int height) {
  if (width == image.width() && height == image.height()) {
    return Image<float>::copy_of(image);
  }
  const std::vector<Between> columns = places_between(image.width(), width, true);
  const std::vector<Between> rows = places_between(image.height(), height, false);
  Image<float> result(width, height);
  const auto along_row = [&](int y, std::vector<float>& row) {
    const float* const source = image.row(y);
    for (std::size_t x = 0; x < columns.size(); ++x) {
      const Between& at = columns[x];
      row[x] = at.before == at.after
                   ? source[at.before]
                   : source[at.before] * at.weight_before + source[at.after] * at.weight_after;
    }
  };
  std::vector<float> above(columns.size());
  std::vector<float> below(columns.size());
  int row_above = -1;
  int row_below = -1;
  const auto hold = [&](int wanted, int& held, std::vector<float>& row) {
    if (held != wanted) {
      along_row(wanted, row);
      held = wanted;
    }
  };
  for (int y = 0; y < height; ++y) {
    const Between& at = rows[static_cast<std::size_t>(y)];
    if (at.before == row_below) {
      std::swap(above, below);
      std::swap(row_above, row_below);
    }
    hold(at.before, row_above, above);
    hold(at.after, row_below, below);
    std::transform(above.begin(), above.end(), below.begin(), result.row(y),
                   [&](float upper, float lower) {
                     return upper * at.weight_before + lower * at.weight_after;
                   });
  }
  return result;
}

}  // namespace vantage
