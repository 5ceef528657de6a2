#include "scheduler/scratch_pool.h"

#include <algorithm>
#include <new>

namespace vantage::scheduler {
namespace {

// A block serves leases down to its size divided by this.
constexpr std::size_t kMaxWaste = 4;

}  // namespace

void ScratchPool::Free::operator()(std::byte* memory) const noexcept {
  ::operator delete (memory, std::align_val_t{kAlignment});
}

ScratchPool::Lease ScratchPool::hand_out(Block block, ScratchUse use) {
  Leased& leased = leased_[static_cast<std::size_t>(use)];
  leased.bytes += block.bytes;
  leased.max_bytes = std::max(leased.max_bytes, leased.bytes);
  block.use = use;
  return {this, std::move(block)};
}

ScratchPool::Lease ScratchPool::lease(std::size_t bytes, ScratchUse use) {
  bytes = std::max<std::size_t>(bytes, kAlignment);
  std::lock_guard lock(mutex_);
  // The smallest block that fits without wasting most of itself: the large ones are for whole-image
  // states, which would otherwise have to be allocated again, page by page.
  auto best = free_.end();
  for (auto it = free_.begin(); it != free_.end(); ++it) {
    if (it->bytes >= bytes && it->bytes <= kMaxWaste * bytes &&
        (best == free_.end() || it->bytes < best->bytes)) {
      best = it;
    }
  }
  if (best != free_.end()) {
    Block block = std::move(*best);
    free_.erase(best);
    return hand_out(std::move(block), use);
  }
  if (!free_.empty()) {
    // The plan has changed: the block that has been idle longest goes, instead of hoarding both.
    bytes_held_ -= free_.front().bytes;
    free_.erase(free_.begin());
    --blocks_;
  }
  free_.reserve(blocks_ + 1);  // so that give_back() cannot fail
  Block block;
  block.memory.reset(static_cast<std::byte*>(::operator new (bytes, std::align_val_t{kAlignment})));
  block.bytes = bytes;
  ++blocks_;
  bytes_held_ += bytes;
  return hand_out(std::move(block), use);
}

void ScratchPool::give_back(Block block) noexcept {
  std::lock_guard lock(mutex_);
  leased_[static_cast<std::size_t>(block.use)].bytes -= block.bytes;
  free_.push_back(std::move(block));
}

std::size_t ScratchPool::bytes_held() const {
  std::lock_guard lock(mutex_);
  return bytes_held_;
}

std::size_t ScratchPool::max_leased_bytes(ScratchUse use) const {
  std::lock_guard lock(mutex_);
  return leased_[static_cast<std::size_t>(use)].max_bytes;
}

}  // namespace vantage::scheduler
