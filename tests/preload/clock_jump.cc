// Preloaded into a program under test: the clock of the day jumps by hours, forth and back, from
// one look at it to the next. Clocks that only count on are left alone.

#include <sys/time.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "tests/preload/next_function.h"

namespace {

// There is nothing to hand a state through.
std::atomic<unsigned> looks{0};  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

time_t jump_s() {
  constexpr std::array<time_t, 5> kJumpsS = {0, 7200, -10800, 86400 * 40, -5};
  return kJumpsS[++looks % kJumpsS.size()];
}

/// So that a test can tell whether the clock was looked at at all.
struct CountAtEnd {
  ~CountAtEnd() {
    if (const char* path = std::getenv("CLOCK_JUMP_COUNT")) {
      if (std::FILE* file = std::fopen(path, "w")) {
        std::fprintf(file, "%u\n", looks.load());
        std::fclose(file);
      }
    }
  }
};
const CountAtEnd count_at_end;

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* now) noexcept {
  const int result = next<int(clockid_t, timespec*)>("clock_gettime")(clock, now);
  if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) {
    now->tv_sec += jump_s();
  }
  return result;
}

int gettimeofday(timeval* now, void* zone) noexcept {
  const int result = next<int(timeval*, void*)>("gettimeofday")(now, zone);
  if (result == 0) {
    now->tv_sec += jump_s();
  }
  return result;
}

time_t time(time_t* now) noexcept {
  const time_t jumped = next<time_t(time_t*)>("time")(nullptr) + jump_s();
  if (now != nullptr) {
    *now = jumped;
  }
  return jumped;
}

}  // extern "C"
