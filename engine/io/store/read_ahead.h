#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace vantage {

/// Whole objects that are fetched before they are asked for: each request waits for the store, so
/// that many at a time take no longer than one. Thread rule: may be used concurrently.
class ReadAhead {
 public:
  using Fetch = std::function<std::vector<std::uint8_t>(const std::string& address)>;
  /// Concurrently called; must outlive this object. Destruction waits for what is under way.
  explicit ReadAhead(Fetch fetch) : fetch_(std::move(fetch)) {}

  /// Begins to fetch. Nothing where that has begun, or too many are under way.
  void begin(const std::string& address);
  /// What begin() has fetched, once; it waits for that, and throws as `fetch`. Empty: it has not
  /// begun.
  std::optional<std::vector<std::uint8_t>> take(const std::string& address);

 private:
  struct Begun {
    std::string address;
    std::future<std::vector<std::uint8_t>> bytes;
  };
  /// In a forked process nothing is under way.
  void forget_of_parent();

  Fetch fetch_;
  std::mutex mutex_;
  std::list<Begun> begun_;  ///< the oldest first
  pid_t process_ = ::getpid();
};

}  // namespace vantage
