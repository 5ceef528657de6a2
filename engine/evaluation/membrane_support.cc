#include "engine/evaluation/membrane_support.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/core.hpp>
#include <utility>

#include "engine/error.h"
#include "engine/io/images/opencv_setup.h"

namespace vantage {
namespace {

constexpr double kMinBeta = 0.01;
constexpr int kMaxRadius = 256;
/// Side of the torus: at least this, and at least this multiple of the support's radius.
constexpr int kMinTorusSide = 128;
constexpr int kTorusRadii = 4;

void require(double beta, int radius) {
  if (!(beta >= kMinBeta && std::isfinite(beta))) {
    throw UsageError(fmt::format("beta is {}, expected a number of at least {}", beta, kMinBeta));
  }
  if (radius < 1 || radius > kMaxRadius) {
    throw UsageError(fmt::format("radius is {}, expected 1 to {}", radius, kMaxRadius));
  }
}

}  // namespace

SupportFunction::SupportFunction(int radius)
    : radius_(radius), values_(static_cast<std::size_t>((2 * radius + 1) * (2 * radius + 1))) {}

double SupportFunction::sum() const { return std::accumulate(values_.begin(), values_.end(), 0.0); }

SupportFunction membrane_support(double beta, int radius) {
  require(beta, radius);
  prepare_opencv();
  const int side = cv::getOptimalDFTSize(std::max(kMinTorusSide, kTorusRadii * radius));
  cv::Mat spectrum(side, side, CV_64FC2);
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u) {
      const double cos_x = std::cos(2 * std::numbers::pi * u / side);
      const double cos_y = std::cos(2 * std::numbers::pi * v / side);
      spectrum.at<cv::Vec2d>(v, u) = {beta / (beta + 4 - 2 * cos_x - 2 * cos_y), 0};
    }
  }
  cv::Mat impulse;
  cv::dft(spectrum, impulse, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  SupportFunction support(radius);
  for (int dy = -radius; dy <= radius; ++dy) {
    for (int dx = -radius; dx <= radius; ++dx) {
      support.at(dx, dy) = impulse.at<double>((dy + side) % side, (dx + side) % side);
    }
  }
  return support;
}

SupportFunction membrane_impulse_response(double beta, double lambda, int iterations, int radius) {
  require(beta, radius);
  if (!(lambda > 0 && lambda <= 1 / (4 + beta))) {
    throw UsageError(fmt::format("lambda is {}, expected above 0 and at most 1/(4 + beta) = {:.4g}",
                                 lambda, 1 / (4 + beta)));
  }
  if (iterations < 0) {
    throw UsageError(fmt::format("iterations is {}, expected at least 0", iterations));
  }
  SupportFunction now(radius);
  now.at(0, 0) = 1;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    SupportFunction next(radius);
    for (int y = -radius; y <= radius; ++y) {
      for (int x = -radius; x <= radius; ++x) {
        const double first = x == 0 && y == 0 ? 1 : 0;
        double change = beta * (first - now.at(x, y));
        for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
          if (std::abs(x + dx) <= radius && std::abs(y + dy) <= radius) {
            change += now.at(x + dx, y + dy) - now.at(x, y);
          }
        }
        next.at(x, y) = now.at(x, y) + lambda * change;
      }
    }
    now = std::move(next);
  }
  return now;
}

double largest_difference(const SupportFunction& a, const SupportFunction& b) {
  double largest = 0;
  for (int dy = -a.radius(); dy <= a.radius(); ++dy) {
    for (int dx = -a.radius(); dx <= a.radius(); ++dx) {
      largest = std::max(largest, std::abs(a.at(dx, dy) - b.at(dx, dy)));
    }
  }
  return largest;
}

}  // namespace vantage
