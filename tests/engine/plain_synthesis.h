#pragma once

#include "engine/image/image.h"
#include "engine/synthesis/pair_warpers.h"
#include "engine/synthesis/view_synthesizer.h"
#include "tests/engine/engine_test.h"

namespace vantage {

/// View synthesis on the baseline (EQUATIONS §6) written down once more: in double, one position at
/// a time, whole images, a z-buffer in place of an order.
class PlainView {
 public:
  PlainView(int width, int height, int channels)
      : width_(width),
        channels_(channels),
        values(static_cast<std::size_t>(width * height * channels), 0.0),
        disparity(static_cast<std::size_t>(width * height),
                  -std::numeric_limits<double>::infinity()) {}

  [[nodiscard]] std::size_t position(int x, int y) const {
    return static_cast<std::size_t>(y * width_ + x);
  }
  [[nodiscard]] bool hole_at(int x, int y) const { return std::isinf(disparity[position(x, y)]); }
  [[nodiscard]] double& value_at(int x, int y, int c) {
    return values[position(x, y) * static_cast<std::size_t>(channels_) +
                  static_cast<std::size_t>(c)];
  }
  [[nodiscard]] double value_at(int x, int y, int c) const {
    return values[position(x, y) * static_cast<std::size_t>(channels_) +
                  static_cast<std::size_t>(c)];
  }

 private:
  int width_;
  int channels_;

 public:
  std::vector<double> values;
  std::vector<double> disparity;  ///< −inf = hole
  std::array<IntensityFit, 4> intensity;
};

inline double plain_keys(double t) {
  t = std::abs(t);
  if (t >= 2) {
    return 0;
  }
  return t < 1 ? 1.5 * t * t * t - 2.5 * t * t + 1 : -0.5 * t * t * t + 2.5 * t * t - 4 * t + 2;
}

/// Colour of one row at a fractional column, by taps that show disparity d.
template <typename T>
double plain_fetch(ImageView<const T> image, ImageView<const float> map, int y, int c,
                   double column, double d, double limit) {
  const auto shows = [&](int x) {
    return x >= 0 && x < image.width() && std::abs(map.at(x, y) - d) <= limit;
  };
  const int left = static_cast<int>(std::floor(column));
  const int inner_left = shows(left) ? left : left + 1;
  const int inner_right = shows(left + 1) ? left + 1 : left;
  double sum = 0;
  for (int x = left - 1; x <= left + 2; ++x) {
    int tap = x;
    if (x <= left) {
      tap = inner_left == left && (x == left || shows(x)) ? x : inner_left;
    } else {
      tap = inner_right == left + 1 && (x == left + 1 || shows(x)) ? x : inner_right;
    }
    sum += plain_keys(column - x) * static_cast<double>(image.at(tap, y, c));
  }
  return std::clamp(sum, 0.0, 255.0 / static_cast<double>(kGreyLevelsPerUnit<T>));
}

template <typename T>
PlainView plain_warp(ImageView<const T> image, ImageView<const float> map, double s,
                     const SynthesisOptions& options) {
  const int width = image.width();
  const double limit = options.disparity_gradient_limit_px;
  PlainView view(width, image.height(), image.channels());
  for (int y = 0; y < image.height(); ++y) {
    // One sample, from source column u of disparity d, into the z-buffer.
    const auto add = [&](double n, double u, double d) {
      if (n < 0 || n >= width || !(d > view.disparity[view.position(static_cast<int>(n), y)])) {
        return;
      }
      const int x = static_cast<int>(n);
      view.disparity[view.position(x, y)] = d;
      for (int c = 0; c < image.channels(); ++c) {
        const int whole = static_cast<int>(u);
        const double f = u - whole;
        view.value_at(x, y, c) =
            options.warp == WarpColour::kOnePass
                ? plain_fetch(image, map, y, c, n + s * d, d, limit)
                : (1 - f) * static_cast<double>(image.at(whole, y, c)) +
                      (f > 0 ? f * static_cast<double>(image.at(whole + 1, y, c)) : 0);
      }
    };
    for (int x = 0; x < width; ++x) {
      const double d = map.at(x, y);
      if (std::isnan(d)) {
        continue;
      }
      add(std::floor(x - s * d + 0.5), x, d);
      if (x + 1 < width && std::abs(map.at(x + 1, y) - d) <= limit) {
        const double next = map.at(x + 1, y);
        const double from = x - s * d;
        const double to = x + 1 - s * next;
        for (double n = std::floor(from + 0.5) + 1; n < std::floor(to + 0.5); ++n) {
          const double f = (n - from) / (to - from);
          add(n, x + f, d + f * (next - d));
        }
      }
    }
  }
  return view;
}

/// Fills the holes of one row; `view` still has the disparities of before.
inline void plain_fill_row(PlainView& view, int width, int channels, int y, double limit,
                           bool mirror) {
  const auto known = [&](int x) { return x >= 0 && x < width && !view.hole_at(x, y); };
  const auto d = [&](int x) { return view.disparity[view.position(x, y)]; };
  for (int x = 0; x < width; ++x) {
    int left = x;
    int right = x;
    while (left >= 0 && !known(left)) {
      --left;
    }
    while (right < width && !known(right)) {
      ++right;
    }
    if (known(x) || (left < 0 && right == width)) {
      continue;
    }
    const bool use_left = right == width || (left >= 0 && d(left) <= d(right));
    const int border = use_left ? left : right;
    const int step = use_left ? -1 : 1;
    int run = 1;
    while (mirror && known(border + run * step) &&
           std::abs(d(border + run * step) - d(border + (run - 1) * step)) <= limit) {
      ++run;
    }
    const int k = (std::abs(x - border) - 1) % (2 * run);
    for (int c = 0; c < channels; ++c) {
      view.value_at(x, y, c) = view.value_at(border + (k < run ? k : 2 * run - 1 - k) * step, y, c);
    }
  }
}

template <typename T>
PlainView plain_synthesis(const StereoSource<T>& source, const SynthesisOptions& options,
                          double view_x) {
  const int width = source.left.width();
  const int height = source.left.height();
  const int channels = source.left.channels();
  const double unit = static_cast<double>(kGreyLevelsPerUnit<T>);
  const double limit = options.disparity_gradient_limit_px;
  const PlainView left = plain_warp(source.left, source.left_disparity, view_x, options);
  const PlainView right = plain_warp(source.right, source.right_disparity, view_x - 1, options);
  PlainView view(width, height, channels);

  for (int c = 0; c < (channels == 4 ? 3 : channels) && options.match_intensities; ++c) {
    double n = 0, sl = 0, sr = 0, slr = 0, sll = 0;  // (3.11), in grey levels
    for (std::size_t p = 0; p < left.disparity.size(); ++p) {
      if (std::isfinite(left.disparity[p]) && std::isfinite(right.disparity[p]) &&
          std::abs(left.disparity[p] - right.disparity[p]) <= limit) {
        const std::size_t k = p * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c);
        const double l = left.values[k] * unit;
        const double r = right.values[k] * unit;
        n += 1, sl += l, sr += r, slr += l * r, sll += l * l;
      }
    }
    const double determinant = n * sll - sl * sl;
    const double b = (n * slr - sl * sr) / determinant;  // (3.10)
    if (n >= 2 && determinant > 1e-3 * n * n && b >= 1.0 / 16 && b <= 16) {
      view.intensity[static_cast<std::size_t>(c)] = {(sll * sr - sl * slr) / determinant, b};
    }
  }

  const double left_distance = std::abs(view_x);
  const double right_distance = std::abs(view_x - 1);
  const double camera_alpha = right_distance / (left_distance + right_distance);
  const double gamma = options.gamma.value_or(camera_alpha);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t p = view.position(x, y);
      const double dl = left.disparity[p];
      const double dr = right.disparity[p];
      double alpha = camera_alpha;
      if (std::isinf(dl) && std::isinf(dr)) {
        continue;
      }
      if (std::isinf(dl) || std::isinf(dr)) {
        alpha = std::isinf(dr) ? 1 : 0;
      } else if (std::abs(dl - dr) > limit && alpha > 0 && alpha < 1) {
        alpha = dl > dr ? 1 : 0;
      }
      view.disparity[p] = (alpha > 0 ? alpha * dl : 0) + (alpha < 1 ? (1 - alpha) * dr : 0);
      for (int c = 0; c < channels; ++c) {
        const double a = view.intensity[static_cast<std::size_t>(c)].offset / unit;
        const double b = view.intensity[static_cast<std::size_t>(c)].gain;
        const double l = left.value_at(x, y, c);
        const double r = right.value_at(x, y, c);
        const double sum = alpha * (gamma * l + (1 - gamma) * (a + b * l)) +
                           (1 - alpha) * (gamma * (r - a) / b + (1 - gamma) * r);  // (3.12)
        view.value_at(x, y, c) = std::clamp(sum, 0.0, 255.0 / unit);
      }
    }
    if (options.holes != HoleFilling::kNone) {
      plain_fill_row(view, width, channels, y, limit, options.holes == HoleFilling::kMirror);
    }
  }

  const auto empty = [&](int y) {
    for (int x = 0; x < width; ++x) {
      if (!view.hole_at(x, y)) {
        return false;
      }
    }
    return true;
  };
  for (int y = 0; y < height && options.holes != HoleFilling::kNone; ++y) {
    for (int distance = 1; empty(y) && distance < height; ++distance) {
      const int from = y - distance >= 0 && !empty(y - distance) ? y - distance : y + distance;
      if (from < height && !empty(from)) {
        for (int k = 0; k < width * channels; ++k) {
          view.value_at(0, y, k) = view.value_at(0, from, k);
        }
        break;
      }
    }
  }
  return view;
}

}  // namespace vantage
