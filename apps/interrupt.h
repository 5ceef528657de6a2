#pragma once

#include <atomic>

namespace vantage::apps {

/// From the first call on, the first SIGINT or SIGTERM raises the returned flag instead of ending
/// the process; the second one ends it as usual. For commands that then finish what is under way.
const std::atomic<bool>& interrupt_flag();

}  // namespace vantage::apps
