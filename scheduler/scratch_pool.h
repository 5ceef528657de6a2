#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace vantage::scheduler {

/// Purpose of leased memory, for profiles.
enum class ScratchUse : std::uint8_t {
  kRings,   ///< rows and states of a strip's sweep
  kStored,  ///< states of whole rows between passes
  kOther
};

/// Aligned memory that tasks lease and return, so that equal tasks allocate only once.
/// Thread rule: all members may be called concurrently. A lease must not outlive the pool.
class ScratchPool {
  struct Free {
    void operator()(std::byte* memory) const noexcept;
  };
  struct Block {
    std::unique_ptr<std::byte, Free> memory;
    std::size_t bytes = 0;
    ScratchUse use = ScratchUse::kOther;
  };

 public:
  static constexpr std::size_t kAlignment = 64;

  /// Holds memory until it is destroyed or assigned to; a default lease holds none.
  class Lease {
   public:
    Lease() = default;
    Lease(Lease&& other) noexcept { *this = std::move(other); }
    Lease& operator=(Lease&& other) noexcept {
      std::swap(pool_, other.pool_);
      std::swap(block_, other.block_);
      return *this;
    }
    ~Lease() {
      if (pool_ != nullptr) {
        pool_->give_back(std::move(block_));
      }
    }
    /// Uninitialised, aligned to kAlignment.
    [[nodiscard]] std::byte* data() const { return block_.memory.get(); }

   private:
    friend class ScratchPool;
    Lease(ScratchPool* pool, Block block) : pool_(pool), block_(std::move(block)) {}
    ScratchPool* pool_ = nullptr;
    Block block_;
  };

  /// At least `bytes` of memory. Throws std::bad_alloc.
  [[nodiscard]] Lease lease(std::size_t bytes, ScratchUse use = ScratchUse::kOther);

  /// Bytes that this pool holds, leased or free.
  [[nodiscard]] std::size_t bytes_held() const;
  /// Peak of the bytes leased for `use`.
  [[nodiscard]] std::size_t max_leased_bytes(ScratchUse use) const;

 private:
  struct Leased {
    std::size_t bytes = 0;
    std::size_t max_bytes = 0;
  };

  [[nodiscard]] Lease hand_out(Block block, ScratchUse use);
  void give_back(Block block) noexcept;

  mutable std::mutex mutex_;
  std::vector<Block> free_;
  std::size_t blocks_ = 0;
  std::size_t bytes_held_ = 0;
  std::array<Leased, 3> leased_;  // by use
};

}  // namespace vantage::scheduler
