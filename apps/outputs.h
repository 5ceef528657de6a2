#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace vantage::apps {

/// What kinds of files an output option can write.
enum class OutputKind {
  kDisparity,
  kDisplacements,  ///< both components of a two-dimensional search
  kConfidence,
  kPhotograph,
  kMask,
  kVideo,
  kTable,  ///< numbers: .csv or .npy
  kPage,   ///< .html
  kPlot,   ///< a chart: .svg or a picture
  kText
};

/// The outputs and inputs of a command, checked before any work starts.
class FileChecks {
 public:
  /// An input of the command. An empty path is ignored, here and below.
  void add_input(const std::string& path);
  /// An output named by `option` ("--output"). Throws UsageError when the extension is not one that
  /// `kind` can be written as, or when the file is an input or another output as well; Error when
  /// its folder is missing or cannot be written, or it is a folder itself.
  void add_output(const std::string& path, const std::string& option, OutputKind kind);

 private:
  std::vector<std::filesystem::path> inputs_;
  std::map<std::filesystem::path, std::string> outputs_;  ///< resolved path → option
};

/// `path`, absolute and without links as far as it exists: equal for equal places.
std::filesystem::path resolved(const std::filesystem::path& path);

/// Whether `path` is a printf pattern: it has a '%'.
bool is_pattern(const std::string& path);
/// `pattern` with its %d or %0Nd replaced by `index`. Throws UsageError when it does not hold
/// exactly one.
std::string expand_pattern(const std::string& pattern, int index);

/// `path` ends in the extension (with the dot, lower case), in any letter case.
bool has_extension(const std::filesystem::path& path, const std::vector<std::string>& extensions);

}  // namespace vantage::apps
