#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/rectification/feature_matches.h"

namespace vantage {

/// Features of a photograph, to be matched with those of any others.
///
/// Thread rule: immutable; everything here may be called concurrently and is deterministic.
class ImageFeatures {
 public:
  /// Throws UsageError for invalid options.
  ImageFeatures(const Photograph& photograph, const FeatureMatchOptions& options);
  ~ImageFeatures();
  ImageFeatures(ImageFeatures&&) noexcept;
  ImageFeatures& operator=(ImageFeatures&&) = delete;

  [[nodiscard]] int count() const;
  /// Of a feature, in the photograph.
  [[nodiscard]] Eigen::Vector2d position_px(int feature) const;

  struct Content;
  [[nodiscard]] const Content& content() const { return *content_; }

 private:
  std::unique_ptr<const Content> content_;
};

/// Numbers of the features of two photographs whose descriptors are mutually nearest, and clearly
/// nearer than the second nearest; of the same kind. Features are in the order of their strength:
/// `strongest` (1 or more) of both photographs are compared.
std::vector<std::array<int, 2>> mutual_features(const ImageFeatures& left,
                                                const ImageFeatures& right,
                                                int strongest = std::numeric_limits<int>::max());

/// The sub-pixel positions in the right photograph where its features agree best with their
/// partners in the left one (Lucas–Kanade on local contrast, so exposure does not matter); empty
/// where that fails or is more than two pixels away.
std::vector<std::optional<Eigen::Vector2d>> refined_partners(
    const ImageFeatures& left, const ImageFeatures& right,
    std::span<const std::array<int, 2>> pairs);

}  // namespace vantage
