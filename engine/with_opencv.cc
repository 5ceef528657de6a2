#include "engine/with_opencv.h"

namespace vantage {

bool has_opencv() { return true; }

}  // namespace vantage
