#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/process/outputs.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage::apps {

/// Where generated pictures go: DIR/left.png for a single frame, DIR/left/000000.png for a
/// sequence. Folders are made when the first file is written to them.
class GeneratedFiles {
 public:
  /// Throws Error when `folder` cannot be made.
  GeneratedFiles(std::filesystem::path folder, bool sequence);

  /// Tells `checks` what is going to be written to `folder` as --output: pictures and maps of these
  /// names.
  static void check(const std::filesystem::path& folder, bool sequence,
                    const std::vector<std::string>& names, FileChecks& checks);

  // Each writes the file `name` of frame `frame`: integer pictures as PNG, float ones and
  // disparities as PFM, masks as PNG. Throw Error.
  void write(const std::string& name, int frame, const Photograph& photograph) const;
  void write(const std::string& name, int frame, const DisparityMap& disparity) const;
  void write(const std::string& name, int frame, const Mask& mask) const;
  /// Writes DIR/NAME, which belongs to all frames. Throws Error, also if it is there with other
  /// content and not to be replaced.
  void write_text(const std::string& name, const std::string& text, bool overwrite) const;

 private:
  [[nodiscard]] std::filesystem::path file(const std::string& name, int frame,
                                           const std::string& extension) const;

  std::filesystem::path folder_;
  bool sequence_;
};

}  // namespace vantage::apps
