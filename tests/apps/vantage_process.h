#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vantage {

/// How a run of the binary ended.
struct ProcessResult {
  int exit_code = 0;  ///< 128 + signal when a signal ended it
  std::string out;
  std::string err;
};

/// Starts the `vantage` binary without a shell; its output goes to files in `folder`.
class VantageProcess {
 public:
  /// `environment`: variables ("NAME=value") beside, or instead of, those of this process. Without
  /// an XDG_CONFIG_HOME among them, that is a folder that is not there.
  VantageProcess(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                 const std::vector<std::string>& environment = {});
  VantageProcess(const VantageProcess&) = delete;
  VantageProcess& operator=(const VantageProcess&) = delete;

  void send(int signal) const;
  /// Whether it is no longer running; wait() is to be called all the same.
  [[nodiscard]] bool has_ended() const;
  /// What it has printed on stderr so far.
  [[nodiscard]] std::string err() const;
  /// Call it once.
  [[nodiscard]] ProcessResult wait() const;

 private:
  std::filesystem::path out_;
  std::filesystem::path err_;
  int pid_ = 0;
};

/// Runs the binary to its end.
ProcessResult run_vantage(const std::vector<std::string>& arguments,
                          const std::vector<std::string>& environment = {});

/// The whole file.
std::string read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, const std::string& content);
/// Names of all files below `folder`, relative to it, sorted. Hidden ones included.
std::vector<std::string> files_below(const std::filesystem::path& folder);

}  // namespace vantage
