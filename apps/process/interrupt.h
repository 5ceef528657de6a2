#pragma once

#include <atomic>

namespace vantage::apps {

/// From now on SIGINT, SIGTERM and SIGHUP end the process as usual, but without leaving temporary
/// files. A signal that is ignored stays so.
void remove_files_on_signals();

/// After the first call, the first SIGINT, SIGTERM or SIGHUP sets the returned flag instead of
/// ending the process; the second one of its kind ends it as above. For commands that finish the
/// work in flight first. SIGHUP stays ignored if it was (nohup).
const std::atomic<bool>& interrupt_flag();

/// Sets that flag, as the first signal does.
void request_end();

/// The flag, for work that ends early where a command waits for it. Thread rule: any thread.
bool is_end_requested();

}  // namespace vantage::apps
