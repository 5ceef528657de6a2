#include "engine/pose_estimation/feature_tracks.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>

namespace vantage {

std::vector<std::vector<FeatureOfImage>> feature_tracks(std::span<const PairGeometry> pairs) {
  std::map<FeatureOfImage, std::size_t> numbers;
  for (const PairGeometry& pair : pairs) {
    for (const auto& [first, second] : pair.inliers) {
      numbers.emplace(FeatureOfImage{pair.first, first}, 0);
      numbers.emplace(FeatureOfImage{pair.second, second}, 0);
    }
  }
  std::size_t count = 0;
  for (auto& [feature, number] : numbers) {
    number = count++;
  }
  std::vector<std::size_t> parents(count);
  std::iota(parents.begin(), parents.end(), std::size_t{0});
  const auto root_of = [&](std::size_t number) {
    while (parents[number] != number) {
      parents[number] = parents[parents[number]];
      number = parents[number];
    }
    return number;
  };
  for (const PairGeometry& pair : pairs) {
    for (const auto& [first, second] : pair.inliers) {
      const std::size_t a = root_of(numbers.at({pair.first, first}));
      const std::size_t b = root_of(numbers.at({pair.second, second}));
      parents[std::max(a, b)] = std::min(a, b);
    }
  }
  std::map<std::size_t, std::vector<FeatureOfImage>> groups;
  for (const auto& [feature, number] : numbers) {
    groups[root_of(number)].push_back(feature);
  }
  std::vector<std::vector<FeatureOfImage>> tracks;
  for (auto& [root, features] : groups) {
    const bool is_twice_in_one =
        std::ranges::adjacent_find(features, {}, &FeatureOfImage::image) != features.end();
    if (features.size() >= 2 && !is_twice_in_one) {
      tracks.push_back(std::move(features));
    }
  }
  return tracks;
}

}  // namespace vantage
