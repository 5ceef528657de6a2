#include "apps/process/process_setup.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <initializer_list>
#include <new>
#include <string_view>

#include "apps/commands/commands.h"
#include "apps/process/child_process.h"
#include "apps/process/interrupt.h"
#include "apps/process/tell.h"
#include "engine/io/files/unfinished_files.h"

namespace vantage::apps {
namespace {

/// Given back when memory is used up for the first time, for what ends the work: destructors of
/// JSON values allocate, messages do. Large enough to be a mapping of its own.
constexpr std::size_t kReserveBytes = std::size_t{512} << 10;
std::atomic<void*> reserve{nullptr};  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
std::string_view name_of_process;     // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

void give_reserve_back() {
  void* const block = reserve.exchange(nullptr);
  if (block == nullptr) {
    throw std::bad_alloc();
  }
  std::free(block);  // NOLINT(cppcoreguidelines-no-malloc)
}

/// In place of the C++ library's, which prints to the stream that keep_libraries_quiet() closes.
/// Destructors of JSON values and of OpenCV allocate: where memory ends, that is no defect.
[[noreturn]] void end_by_uncaught_error() {
  tell_text("vantage");
  tell_text(name_of_process.empty() ? "" : " ");
  tell_text(name_of_process);
  const std::exception_ptr error = std::current_exception();
  const char* text = "";
  try {
    if (error) {
      std::rethrow_exception(error);
    }
  } catch (const std::bad_alloc&) {
    tell_text(": out of memory\n");
    remove_unfinished_files();
    std::_Exit(kExitFailed);
  } catch (const std::exception& known) {
    text = known.what();  // `error` keeps it
  } catch (...) {         // has no text
  }
  tell_text(": ended by an error that nothing caught");
  tell_text(*text == '\0' ? "" : ": ");
  tell_text(text);
  tell_text("\n");
  std::abort();
}

/// Some libraries print lines of their own, whatever their log level: x264, where memory ends. What
/// a command has to say goes through tell(), which does not need the C library's stream.
void keep_libraries_quiet() {
#ifdef __GLIBC__
  if (std::FILE* const nowhere = std::fopen("/dev/null", "we"); nowhere != nullptr) {
    stderr = nowhere;
  }
  std::set_terminate(end_by_uncaught_error);
#endif
}

}  // namespace

void name_process(std::string_view command) { name_of_process = command; }

void set_up_process() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) == -1) {
      // open() returns the lowest free number, which is this one. It is open for reading, so writes
      // fail.
      (void)::open("/dev/null", O_RDONLY);
    }
  }
  keep_libraries_quiet();
  (void)std::signal(SIGPIPE, SIG_IGN);
  (void)std::signal(SIGXFSZ, SIG_IGN);
  remove_files_on_signals();
  end_with_parent();
  reserve = std::malloc(kReserveBytes);  // NOLINT(cppcoreguidelines-no-malloc)
  std::set_new_handler(give_reserve_back);
}

}  // namespace vantage::apps
