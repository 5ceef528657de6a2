#pragma once

#include <atomic>

namespace vantage::apps {

/// From the first call on, the first SIGINT, SIGTERM or SIGHUP raises the returned flag instead of
/// ending the process; the second one ends it as usual. For commands that then finish what is under
/// way. SIGHUP stays ignored where it is (nohup).
const std::atomic<bool>& interrupt_flag();

}  // namespace vantage::apps
