#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "engine/io/store/object_store.h"

namespace vantage {

/// The right to do something alone among many workers, which shows signs of life as long as it
/// lives. Objects PREFIX/NAME/000001, 000002, … are its generations: who creates one first holds
/// it. So no clocks are compared, and a plain folder and any object store serve.
class Lease {
 public:
  ~Lease();
  Lease(const Lease&) = delete;
  Lease& operator=(const Lease&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  /// How many holders before this one died.
  [[nodiscard]] int abandoned() const { return abandoned_; }
  /// Work is done: nobody needs it any more. Throws Error.
  void finish();
  /// Others may go on at once. Throws Error.
  void hand_back();

 private:
  friend class Leases;
  Lease(ObjectStore& store, std::string prefix, std::string name, int generation, int abandoned,
        std::string holder, std::chrono::duration<double> lease);
  void show_life();
  void stop_showing_life();
  [[nodiscard]] std::string key(int generation) const;

  ObjectStore& store_;
  std::string prefix_;
  std::string name_;
  int generation_;
  int abandoned_;
  std::string holder_;
  std::chrono::duration<double> lease_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool ends_ = false;
  std::thread life_;  ///< last: it uses the others
};

/// The leases of a batch as one worker sees them. Thread rule: one thread at a time.
class Leases {
 public:
  /// Keys begin with `prefix`. `holder` names this worker for people. A holder that shows no life
  /// for `lease` is dead.
  Leases(ObjectStore& store, std::string prefix, std::string holder,
         std::chrono::duration<double> lease);

  /// Looks at all leases; who showed life since the last look lives. Throws Error.
  void look();
  /// Whether take() may succeed, by what was seen.
  [[nodiscard]] bool may_be_free(const std::string& name) const;
  /// Null: another worker has it, or had it at the last look and may live. Throws Error.
  std::unique_ptr<Lease> take(const std::string& name);

 private:
  using Clock = std::chrono::steady_clock;
  struct Seen {
    int generation = 0;    ///< the newest
    int returned = 0;      ///< generations that were handed back
    bool is_back = false;  ///< the newest was handed back
    std::string etag;
    Clock::time_point since;  ///< when this sign of life was seen first
  };

  ObjectStore& store_;
  std::string prefix_;
  std::string holder_;
  std::chrono::duration<double> lease_;
  Clock::time_point last_look_;
  std::map<std::string, Seen> seen_;
};

}  // namespace vantage
