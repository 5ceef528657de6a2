#include "engine/io/store/block_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <utility>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr std::uint64_t kBlockBytes = 4U << 20;
constexpr std::size_t kKeptBlocks = 4;
/// A server without ranges sends all; more than this is not kept in memory.
constexpr std::uint64_t kMaxWholeBytes = 256U << 20;

bool holds(const ObjectPart& block, std::uint64_t place) {
  return place >= block.begin && place - block.begin < block.bytes.size();
}

bool is_ready(const std::future<ObjectPart>& part) {
  return part.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

BlockReader::BlockReader(std::shared_ptr<ObjectStore> store, std::string key, ObjectInfo info,
                         const HttpClient& client)
    : store_(std::move(store)), key_(std::move(key)), info_(std::move(info)), client_(client) {}

BlockReader::~BlockReader() { is_cancelled_ = true; }

ObjectPart BlockReader::fetch(std::uint64_t index) {
  return store_->read(key_, ByteRange{index * kBlockBytes, kBlockBytes}, info_.etag,
                      kMaxWholeBytes);
}

ObjectPart BlockReader::take_ahead() {
  constexpr std::chrono::milliseconds kStep{50};
  while (ahead_->part.wait_for(kStep) != std::future_status::ready) {
    client_.check_interruption();
  }
  std::future<ObjectPart> part = std::move(ahead_->part);
  ahead_.reset();
  return part.get();
}

const ObjectPart& BlockReader::block_with(std::uint64_t place) {
  const std::uint64_t index = place / kBlockBytes;
  const auto find = [&](std::uint64_t byte) {
    return std::ranges::find_if(blocks_,
                                [&](const ObjectPart& block) { return holds(block, byte); });
  };
  auto block = find(place);
  if (block == blocks_.end()) {
    if (ahead_ && (ahead_->index == index || is_ready(ahead_->part))) {
      blocks_.push_front(take_ahead());
      block = find(place);
    }
    block = block == blocks_.end() ? blocks_.insert(block, fetch(index)) : block;
    if (!holds(*block, place)) {
      blocks_.erase(block);
      throw Error(fmt::format("{}: its store sends other bytes than those asked for", key_));
    }
  }
  blocks_.splice(blocks_.begin(), blocks_, block);
  blocks_.resize(std::min(blocks_.size(), kKeptBlocks));
  const std::uint64_t next = index + 1;
  const bool is_in_order = index > 0 && find(index * kBlockBytes - 1) != blocks_.end();
  if (is_in_order && !ahead_ && next * kBlockBytes < info_.bytes &&
      find(next * kBlockBytes) == blocks_.end()) {
    ahead_ = Ahead{next, std::async(std::launch::async, [this, next] {
                     const HttpClient::CancelScope scope(is_cancelled_);
                     return fetch(next);
                   })};
  }
  return blocks_.front();
}

std::size_t BlockReader::read(std::uint64_t offset, std::span<std::uint8_t> bytes) {
  const std::scoped_lock lock(mutex_);
  std::size_t filled = 0;
  while (filled < bytes.size() && offset + filled < info_.bytes) {
    const ObjectPart& block = block_with(offset + filled);
    const std::uint64_t begin = offset + filled - block.begin;
    const std::size_t count =
        std::min(bytes.size() - filled, block.bytes.size() - static_cast<std::size_t>(begin));
    std::memcpy(bytes.data() + filled, block.bytes.data() + begin, count);
    filled += count;
  }
  return filled;
}

}  // namespace vantage
