#pragma once

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace vantage {

/// Lends working memory of type T to concurrent calls and keeps it for later ones. Loans must not
/// outlive the pool. Thread rule: borrow() may be called concurrently.
template <typename T>
class ObjectPool {
 public:
  class Loan {
   public:
    Loan(ObjectPool& pool, std::unique_ptr<T> object) : pool_(pool), object_(std::move(object)) {}
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    ~Loan() {
      const std::lock_guard lock(pool_.mutex_);
      pool_.free_.push_back(std::move(object_));
    }
    T& operator*() const { return *object_; }
    T* operator->() const { return object_.get(); }

   private:
    ObjectPool& pool_;
    std::unique_ptr<T> object_;
  };

  /// Calls visit(object) for all objects that are not lent.
  template <typename Visit>
  void for_each_idle(const Visit& visit) const {
    const std::lock_guard lock(mutex_);
    for (const std::unique_ptr<T>& object : free_) {
      visit(*object);
    }
  }

  /// args: for the constructor of a new object.
  template <typename... Args>
  [[nodiscard]] Loan borrow(const Args&... args) {
    return borrow_best([](const T& /*object*/) { return true; }, args...);
  }
  /// Of idle objects the one returned last that `suits`, else the one idle for longest.
  template <typename Suits, typename... Args>
  [[nodiscard]] Loan borrow_best(const Suits& suits, const Args&... args) {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) {
      free_.reserve(++created_);  // so that returning an object cannot fail
      return {*this, std::make_unique<T>(args...)};
    }
    const auto best = std::find_if(free_.rbegin(), free_.rend(),
                                   [&suits](const auto& object) { return suits(*object); });
    std::rotate(best == free_.rend() ? free_.begin() : best.base() - 1,
                best == free_.rend() ? free_.begin() + 1 : best.base(), free_.end());
    std::unique_ptr<T> object = std::move(free_.back());
    free_.pop_back();
    return {*this, std::move(object)};
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<T>> free_;
  std::size_t created_ = 0;
};

}  // namespace vantage
