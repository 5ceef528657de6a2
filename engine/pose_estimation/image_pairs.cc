#include "engine/pose_estimation/image_pairs.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <set>
#include <utility>

namespace vantage {
namespace {

constexpr int kStrongestFeatures = 400;

using NumberPair = std::pair<int, int>;

std::vector<NumberPair> all_pairs(int images) {
  std::vector<NumberPair> pairs;
  for (int first = 0; first < images; ++first) {
    for (int second = first + 1; second < images; ++second) {
      pairs.emplace_back(first, second);
    }
  }
  return pairs;
}

std::vector<NumberPair> likely_pairs(const std::vector<ImageFeatures>& images, int partners,
                                     const StepProgress& progress, Execution& execution) {
  const int count = static_cast<int>(images.size());
  std::vector<NumberPair> pairs = all_pairs(count);
  if (count <= partners + 1) {
    return pairs;
  }
  std::vector<std::size_t> shared(pairs.size());
  for_each_piece("comparing images", pairs.size(), progress, execution, [&](std::size_t i) {
    shared[i] =
        mutual_features(images[static_cast<std::size_t>(pairs[i].first)],
                        images[static_cast<std::size_t>(pairs[i].second)], kStrongestFeatures)
            .size();
  });
  std::set<NumberPair> chosen;
  for (int image = 0; image < count; ++image) {
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (pairs[i].first == image || pairs[i].second == image) {
        own.push_back(i);
      }
    }
    std::ranges::stable_sort(own, std::ranges::greater(), [&](std::size_t i) { return shared[i]; });
    for (std::size_t i = 0; i < own.size() && i < static_cast<std::size_t>(partners); ++i) {
      chosen.insert(pairs[own[i]]);
    }
    if (image + 1 < count) {
      chosen.insert({image, image + 1});
    }
  }
  return {chosen.begin(), chosen.end()};
}

}  // namespace

void for_each_piece(std::string_view step, std::size_t count, const StepProgress& progress,
                    Execution& execution, const std::function<void(std::size_t)>& body) {
  std::mutex telling;
  int done = 0;
  execution.executor().parallel_for(static_cast<int>(count), [&](int piece) {
    body(static_cast<std::size_t>(piece));
    if (progress) {
      const std::lock_guard lock(telling);
      progress(step, ++done, static_cast<int>(count));
    }
  });
}

LensPositions::LensPositions(const std::optional<Camera>& lens, int width_px, int height_px)
    : centre_px_((width_px - 1) / 2.0, (height_px - 1) / 2.0) {
  if (lens) {
    model_.emplace(*lens);
    focal_px_ = lens->matrix(0, 0);
  }
}

std::optional<Eigen::Vector2d> LensPositions::of(const Eigen::Vector2d& pixel) const {
  if (!model_) {
    return pixel - centre_px_;
  }
  const auto ray = model_->ray_of(pixel);
  return ray ? std::optional<Eigen::Vector2d>(*focal_px_ * *ray) : std::nullopt;
}

std::optional<double> LensPositions::focal_px() const { return focal_px_; }

std::vector<MatchedPair> match_image_pairs(const std::vector<ImageFeatures>& images,
                                           const LensPositions& positions, int partners,
                                           const StepProgress& progress, Execution& execution) {
  const std::vector<NumberPair> likely = likely_pairs(images, partners, progress, execution);
  std::vector<MatchedPair> pairs(likely.size());
  for_each_piece("matching images", pairs.size(), progress, execution, [&](std::size_t i) {
    MatchedPair& pair = pairs[i];
    std::tie(pair.first, pair.second) = likely[i];
    const ImageFeatures& first = images[static_cast<std::size_t>(pair.first)];
    const ImageFeatures& second = images[static_cast<std::size_t>(pair.second)];
    const std::vector<std::array<int, 2>> mutual = mutual_features(first, second);
    const auto refined = refined_partners(first, second, mutual);
    for (std::size_t k = 0; k < mutual.size(); ++k) {
      const auto left = positions.of(first.position_px(mutual[k][0]));
      const auto right = positions.of(refined[k].value_or(second.position_px(mutual[k][1])));
      if (left && right) {
        pair.features.push_back(mutual[k]);
        pair.positions.push_back({.left = *left, .right = *right});
      }
    }
  });
  return pairs;
}

double focal_length_of(const std::vector<MatchedPair>& pairs, double side_px,
                       Execution& execution) {
  constexpr int kCandidates = 60;
  constexpr double kMinFocal = 0.5;  // of the longer side, as the next two
  constexpr double kMaxFocal = 4;
  constexpr double kUsualFocalLength = 1.2;
  constexpr double kDrawToUsual = 0.01;
  std::vector<double> candidates;
  for (int i = 0; i < kCandidates; ++i) {
    candidates.push_back(side_px * kMinFocal *
                         std::pow(kMaxFocal / kMinFocal, i / (kCandidates - 1.0)));
  }
  std::vector<std::vector<double>> disagreements(pairs.size());
  execution.executor().parallel_for(static_cast<int>(pairs.size()), [&](int number) {
    const auto i = static_cast<std::size_t>(number);
    disagreements[i] = focal_disagreements(pairs[i].positions, candidates);
  });
  double best = side_px * kUsualFocalLength;
  double best_cost = 1e300;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    double cost = 0;
    double weights = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (!disagreements[i].empty()) {
        const double weight = std::sqrt(static_cast<double>(pairs[i].positions.size()));
        cost += weight * disagreements[i][k];
        weights += weight;
      }
    }
    cost = cost / std::max(weights, 1.0) +
           kDrawToUsual * std::pow(std::log(candidates[k] / (kUsualFocalLength * side_px)), 2);
    if (cost < best_cost) {
      best_cost = cost;
      best = candidates[k];
    }
  }
  return best;
}

}  // namespace vantage
