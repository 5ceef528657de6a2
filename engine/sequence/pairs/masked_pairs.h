#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "engine/io/images/scene_mask.h"
#include "engine/sequence/pairs/forwarded_pairs.h"

namespace vantage {

/// The pairs of another source, without the pixels that show no scene (leave_out_of_pair()). Masks
/// of files belong to pairs by their index in the input; where some frames are in no pair and there
/// are as many masks as frames, to those. Black borders are those of pairs from the beginning of
/// the input together, whichever pairs are fetched; `each_alone`: of each pair.
class MaskedPairs final : public ForwardedPairs {
 public:
  /// Throws Error when masks cannot be opened, or are neither one nor as many as the pairs.
  MaskedPairs(std::unique_ptr<PairSource> source, SceneMaskOptions options, bool each_alone);

  bool fetch(FramePair& pair) override;
  void skip_to(int index) override;
  [[nodiscard]] const WhiteLevel& white_level() const override { return source_->white_level(); }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override;
  [[nodiscard]] std::vector<std::string> identities() const override;

 private:
  void make_images(FramePair& pair) const override;
  void find_borders();

  SceneMaskOptions options_;
  std::array<std::unique_ptr<FrameSource>, 2> masks_;  ///< null: none
  bool needs_borders_;                                 ///< they are still to be found
  bool each_alone_;
  std::array<Mask, 2> borders_;
  int next_index_ = 0;
};

}  // namespace vantage
