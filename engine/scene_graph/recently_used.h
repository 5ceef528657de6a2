#pragma once

#include <cstddef>
#include <list>
#include <utility>

namespace vantage {

/// The last few values that were asked for, by key. Thread rule: one thread at a time.
template <typename Key, typename Value>
class RecentlyUsed {
 public:
  explicit RecentlyUsed(std::size_t max) : max_(max) {}

  /// The value of `key`, made by make() if it is not kept. Valid until `max` others have been asked
  /// for.
  template <typename Make>
  const Value& get(const Key& key, const Make& make) {
    auto found = kept_.begin();
    while (found != kept_.end() && found->first != key) {
      ++found;
    }
    if (found != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, found);
    } else {
      kept_.emplace_front(key, make());
      if (kept_.size() > max_) {
        kept_.pop_back();
      }
    }
    return kept_.front().second;
  }

 private:
  std::size_t max_;
  std::list<std::pair<Key, Value>> kept_;  // the last one first
};

}  // namespace vantage
