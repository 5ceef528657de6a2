#include "engine/build_info.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <fstream>
#include <opencv2/core/utility.hpp>

#include "engine/error.h"
#include "engine/late_library.h"
#include "scheduler/tbb_executor.h"

extern "C" {
#include <libavutil/avutil.h>
#include <libavutil/macros.h>
}

namespace vantage {
namespace {

/// The value of the first line "KEY<separator>VALUE" of a file, without quotes and white space
/// around it; empty if there is none.
std::string value_in_file(const char* path, const std::string& key, char separator) {
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line)) {
    const std::size_t at = line.find(separator);
    if (at == std::string::npos || line.compare(0, key.size(), key) != 0) {
      continue;
    }
    const std::size_t first = line.find_first_not_of(" \t\"", at + 1);
    const std::size_t last = line.find_last_not_of(" \t\"");
    return first == std::string::npos || last < first ? "" : line.substr(first, last - first + 1);
  }
  return "";
}

}  // namespace

BuildInfo build_info() {
#if defined(__clang__)
  const std::string compiler = fmt::format("Clang {}", __clang_version__);
#else
  const std::string compiler = fmt::format("GCC {}", __VERSION__);
#endif
  return {VANTAGE_VERSION, compiler, cv::getVersionString(), scheduler::tbb_version()};
}

std::string ffmpeg_version() {
  try {
    const LateLibrary library("libavutil.so." AV_STRINGIFY(LIBAVUTIL_VERSION_MAJOR), "no version");
    return library.function<decltype(&::av_version_info)>("av_version_info")();
  } catch (const Error&) {
    return "";
  }
}

SystemInfo system_info() {
  SystemInfo info;
  info.distribution = value_in_file("/etc/os-release", "PRETTY_NAME", '=');
  if (utsname system = {}; uname(&system) == 0) {
    info.kernel = fmt::format("{} {} {}", system.sysname, system.release, system.machine);
  }
  info.processor = value_in_file("/proc/cpuinfo", "model name", ':');
  return info;
}

}  // namespace vantage
