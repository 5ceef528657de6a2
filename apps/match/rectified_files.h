#pragma once

#include <filesystem>
#include <string>

#include "apps/process/outputs.h"
#include "engine/image/side.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage::apps {

/// Where rectified images go: under the names of their photographs, as PNG, or PFM for floats. One
/// pair: DIR/NAME.png, or DIR/left/NAME.png and DIR/right/NAME.png if both have one name. Several
/// pairs: DIR/left/NAME.png and so on. Frames of videos have their number as name.
class RectifiedFiles {
 public:
  /// `first` is the first pair of `pairs`, fetched.
  RectifiedFiles(std::filesystem::path folder, const PairSource& pairs, const FramePair& first);

  /// Tells `files` what is going to be written. Throws UsageError if two photographs of one camera
  /// would get one name.
  void check(const PairSource& pairs, FileChecks& files) const;
  /// Makes folders as needed. Throws Error.
  void write(Side side, const FramePair& pair) const;

 private:
  /// Without extension.
  [[nodiscard]] std::filesystem::path path(Side side, const FramePair& pair) const;

  std::filesystem::path folder_;
  bool has_folders_;                ///< one for each side
  std::filesystem::path first_[2];  ///< of the first pair
};

}  // namespace vantage::apps
