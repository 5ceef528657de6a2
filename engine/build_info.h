#pragma once

#include <string>

namespace vantage {

/// Version, compiler and libraries of this build. Thread rule: pure.
struct BuildInfo {
  std::string version;   ///< of Vantage, "1.2.3"
  std::string compiler;  ///< "GCC 12.2.0"
  std::string opencv;    ///< version in use
  std::string tbb;       ///< version in use
};

BuildInfo build_info();

/// Version of the FFmpeg in use, which is opened for it; empty if there is none. Thread rule: may
/// be used concurrently.
std::string ffmpeg_version();

/// What this process runs on. A field is empty if the system does not tell.
struct SystemInfo {
  std::string distribution;  ///< "Debian GNU/Linux 12 (bookworm)"
  std::string kernel;        ///< "Linux 6.1.0 x86_64"
  std::string processor;     ///< "AMD EPYC 9B14"
};

/// Reads /etc/os-release, uname and /proc/cpuinfo. Thread rule: may be used concurrently.
SystemInfo system_info();

}  // namespace vantage
