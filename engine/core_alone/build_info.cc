#include "engine/build_info.h"

namespace vantage {

BuildInfo build_info() { return {.version = VANTAGE_VERSION, .compiler = __VERSION__}; }

}  // namespace vantage
