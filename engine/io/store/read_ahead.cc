#include "engine/io/store/read_ahead.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace vantage {
namespace {

/// Two images of each of eight pairs; what is not asked for gives way.
constexpr std::size_t kMaxBegun = 32;

}  // namespace

void ReadAhead::forget_of_parent() {
  if (process_ != ::getpid()) {
    // Their threads are the parent's: waiting for them would never end.
    new std::list<Begun>(std::move(begun_));  // NOLINT(cppcoreguidelines-owning-memory)
    begun_.clear();
    process_ = ::getpid();
  }
}

void ReadAhead::begin(const std::string& address) {
  const std::scoped_lock lock(mutex_);
  forget_of_parent();
  if (std::ranges::find(begun_, address, &Begun::address) != begun_.end()) {
    return;
  }
  if (begun_.size() >= kMaxBegun) {
    if (begun_.front().bytes.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      return;
    }
    begun_.pop_front();
  }
  begun_.push_back({address, std::async(std::launch::async, fetch_, address)});
}

std::optional<std::vector<std::uint8_t>> ReadAhead::take(const std::string& address) {
  std::future<std::vector<std::uint8_t>> bytes;
  {
    const std::scoped_lock lock(mutex_);
    forget_of_parent();
    const auto begun = std::ranges::find(begun_, address, &Begun::address);
    if (begun == begun_.end()) {
      return std::nullopt;
    }
    bytes = std::move(begun->bytes);
    begun_.erase(begun);
  }
  return bytes.get();
}

}  // namespace vantage
