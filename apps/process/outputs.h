#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "engine/options/settings.h"

namespace vantage::apps {

/// What kinds of files an output option can write.
enum class OutputKind {
  kDisparity,
  kDisplacements,  ///< both components of a two-dimensional search
  kConfidence,
  kPhotograph,
  kMask,
  kVideo,
  kTable,   ///< numbers: .csv
  kVolume,  ///< .npy
  kDepth,
  kPoints,  ///< .ply
  kPage,    ///< .html
  kText
};

/// The outputs and inputs of a command, checked before any work starts: no output may be an input
/// or another output. Files are told apart by what they are, so links and other ways of writing a
/// name make no difference. Inputs and outputs may be added in any order; whichever comes last
/// throws. An empty path is ignored.
class FileChecks {
 public:
  /// Knows the inputs that `settings` name, the file of --config among them.
  explicit FileChecks(const Settings& settings);

  /// A file (or folder) that is read and that no setting names by itself: of a list, a frame of a
  /// sequence. Throws UsageError when it is an output or lies in a folder of outputs.
  void add_input(const std::filesystem::path& path);
  /// An output named by `option` ("--output"). Throws UsageError when the extension is not one that
  /// `kind` can be written as, or when the file is an input or another output as well; Error when
  /// its folder is missing or cannot be written, or it is a folder itself.
  void add_output(const std::string& path, const std::string& option, OutputKind kind);
  /// A file that the command makes because of `option`, in a folder that it makes as well.
  void add_made_file(const std::filesystem::path& path, const std::string& option);
  /// A folder in which the command makes files of many names. No input may lie in it.
  void add_made_folder(const std::filesystem::path& path, const std::string& option);
  /// Throws Error if a made file is there, or any file in a made folder: the user has named
  /// neither.
  void require_nothing_made_unless(bool overwrite) const;

 private:
  /// What a file is, whatever it is called.
  struct FileId {
    std::uint64_t device = 0;
    std::uint64_t number = 0;
    friend auto operator<=>(const FileId&, const FileId&) = default;
  };
  struct Output {
    std::string option;
    std::filesystem::path path;
  };
  static bool find_id(const std::filesystem::path& path, FileId& id);
  void add_named_file(const std::filesystem::path& path, const std::string& option);
  [[noreturn]] static void refuse_in_folder(const Output& output, const Output& folder);
  /// The folders that hold a name, and what is behind it if it is a link.
  static std::vector<std::filesystem::path> folders_of(const std::filesystem::path& path);

  std::map<FileId, std::filesystem::path> input_ids_;
  std::set<std::filesystem::path> absent_inputs_;                         ///< resolved
  std::map<std::filesystem::path, std::filesystem::path> input_folders_;  ///< folder → an input
  std::map<std::filesystem::path, Output> outputs_;                       ///< by resolved path
  std::map<FileId, Output> output_ids_;                                   ///< those that are there
  std::map<FileId, Output> made_folders_;                                 ///< those that are there
  std::vector<std::filesystem::path> made_files_;
};

/// `path`, absolute and without links: equal for equal places, whether or not they exist.
std::filesystem::path resolved(const std::filesystem::path& path);

/// Whether `path` is a printf pattern: it has a '%'.
bool is_pattern(const std::string& path);
/// `pattern` with its %d or %0Nd replaced by `index`. Throws UsageError when it does not hold
/// exactly one.
std::string expand_pattern(const std::string& pattern, int index);

/// `path` ends in the extension (with the dot, lower case), in any letter case.
bool has_extension(const std::filesystem::path& path, const std::vector<std::string>& extensions);

}  // namespace vantage::apps
