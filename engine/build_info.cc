#include "engine/build_info.h"

#include <fmt/format.h>

#include <opencv2/core/utility.hpp>

#include "scheduler/tbb_executor.h"

namespace vantage {

BuildInfo build_info() {
#if defined(__clang__)
  const std::string compiler = fmt::format("Clang {}", __clang_version__);
#else
  const std::string compiler = fmt::format("GCC {}", __VERSION__);
#endif
  return {VANTAGE_VERSION, compiler, cv::getVersionString(), scheduler::tbb_version()};
}

}  // namespace vantage
