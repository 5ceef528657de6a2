#pragma once

#include <atomic>

namespace vantage::apps {

/// After the first call, the first SIGINT, SIGTERM or SIGHUP sets the returned flag instead of
/// ending the process; the second one ends it as usual. For commands that finish the work in flight
/// first. SIGHUP stays ignored if it was (nohup).
const std::atomic<bool>& interrupt_flag();

}  // namespace vantage::apps
