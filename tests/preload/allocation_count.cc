// Preloaded into a program under test: counts allocations, and tells at the end how many there were
// of which size: lines "SIZE COUNT", SIZE the power of two that the allocations reach at least.
// Environment: ALLOCATION_COUNT, the file to write.

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

namespace {

constexpr std::size_t kSizes = 48;

// There is nothing to hand a state through.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
std::array<std::atomic<long>, kSizes> counts{};

void count(std::size_t bytes) {
  counts[std::min<std::size_t>(kSizes - 1, bytes == 0 ? 0 : std::bit_width(bytes) - 1)]++;
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

void* malloc(std::size_t bytes) {
  count(bytes);
  return __libc_malloc(bytes);
}

void* calloc(std::size_t members, std::size_t bytes) {
  count(members * bytes);
  return __libc_calloc(members, bytes);
}

void* realloc(void* block, std::size_t bytes) {
  count(bytes);
  return __libc_realloc(block, bytes);
}

void* memalign(std::size_t alignment, std::size_t bytes) {
  count(bytes);
  return __libc_memalign(alignment, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  count(bytes);
  return __libc_memalign(alignment, bytes);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t bytes) {
  count(bytes);
  *block = __libc_memalign(alignment, bytes);
  return *block == nullptr ? 12 : 0;  // ENOMEM
}

}  // extern "C"
