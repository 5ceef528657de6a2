// Preloaded into a program under test: counts allocations, and tells at the end how many there were
// of which size: lines "SIZE COUNT", SIZE the power of two that the allocations reach at least; and
// lets them fail. Environment:
//   ALLOCATION_COUNT  the file to write
//   ALLOCATION_FAIL   number (from 1) of the allocation that gets no memory, nor does the one after
//                     it, with which a program that has a reserve tries again; of those
//   ALLOCATION_BYTES  of at least so many bytes
//   ALLOCATION_MOST   and of at most so many; 0: of any number
// What the system's loader and the libraries that it opens allocate meanwhile does not fail: it
// ends the process.

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

#include "tests/preload/next_function.h"

namespace {

constexpr std::size_t kSizes = 48;

// There is nothing to hand a state through.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
std::array<std::atomic<long>, kSizes> counts{};
std::atomic<long> large{0};  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

/// Libraries that this thread is opening.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
[[gnu::tls_model("initial-exec")]] thread_local int openings = 0;

std::size_t number_in(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? 0 : std::strtoul(text, nullptr, 10);
}

/// Counts an allocation; true when it has to fail.
bool fails(std::size_t bytes) {
  counts[std::min<std::size_t>(kSizes - 1, bytes == 0 ? 0 : std::bit_width(bytes) - 1)]++;
  static const std::size_t failing = number_in("ALLOCATION_FAIL");
  static const std::size_t least = number_in("ALLOCATION_BYTES");
  static const std::size_t most = number_in("ALLOCATION_MOST");
  if (failing == 0 || openings > 0 || bytes < least || (most > 0 && bytes > most)) {
    return false;
  }
  const auto number = static_cast<std::size_t>(++large);
  if (number != failing && number != failing + 1) {
    return false;
  }
  errno = ENOMEM;
  return true;
}

struct WriteAtEnd {
  ~WriteAtEnd() {
    const char* path = std::getenv("ALLOCATION_COUNT");
    std::FILE* file = path == nullptr ? nullptr : std::fopen(path, "w");
    if (file == nullptr) {
      return;
    }
    for (std::size_t size = 0; size < kSizes; ++size) {
      std::fprintf(file, "%zu %ld\n", std::size_t{1} << size, counts[size].load());
    }
    std::fclose(file);
  }
};
const WriteAtEnd write_at_end;

}  // namespace

extern "C" {

// Other names of the C library's functions; dlsym() would allocate itself.
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t members, std::size_t bytes);
void* __libc_realloc(void* block, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);

void* dlopen(const char* file, int flags) noexcept {
  static auto* const open = next<void*(const char*, int)>("dlopen");
  ++openings;
  void* const library = open(file, flags);
  --openings;
  return library;
}

void* malloc(std::size_t bytes) { return fails(bytes) ? nullptr : __libc_malloc(bytes); }

void* calloc(std::size_t members, std::size_t bytes) {
  return fails(members * bytes) ? nullptr : __libc_calloc(members, bytes);
}

void* realloc(void* block, std::size_t bytes) {
  return fails(bytes) ? nullptr : __libc_realloc(block, bytes);
}

void* memalign(std::size_t alignment, std::size_t bytes) {
  return fails(bytes) ? nullptr : __libc_memalign(alignment, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  return fails(bytes) ? nullptr : __libc_memalign(alignment, bytes);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t bytes) {
  *block = fails(bytes) ? nullptr : __libc_memalign(alignment, bytes);
  return *block == nullptr ? ENOMEM : 0;
}

}  // extern "C"
