#include "apps/process/process_setup.h"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <initializer_list>

#include "apps/process/interrupt.h"

namespace vantage::apps {

void set_up_process() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) == -1) {
      // open() returns the lowest free number, which is this one. It is open for reading, so writes
      // fail.
      (void)::open("/dev/null", O_RDONLY);
    }
  }
  (void)std::signal(SIGPIPE, SIG_IGN);
  (void)std::signal(SIGXFSZ, SIG_IGN);
  remove_files_on_signals();
}

}  // namespace vantage::apps
