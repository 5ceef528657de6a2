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

}  // namespace vantage
