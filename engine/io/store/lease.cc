#include "engine/io/store/lease.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <exception>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr std::string_view kBack = ".back";  // beside a generation that was handed back
constexpr int kSignsOfLife = 4;              // per lease

}  // namespace

Lease::Lease(ObjectStore& store, std::string prefix, std::string name, int generation,
             int abandoned, std::string holder, std::chrono::duration<double> lease)
    : store_(store),
      prefix_(std::move(prefix)),
      name_(std::move(name)),
      generation_(generation),
      abandoned_(abandoned),
      holder_(std::move(holder)),
      lease_(lease),
      life_([this] { show_life(); }) {}

Lease::~Lease() { stop_showing_life(); }

std::string Lease::key(int generation) const {
  return fmt::format("{}{}/{:06}", prefix_, name_, generation);
}

void Lease::show_life() {
  std::unique_lock lock(mutex_);
  for (int sign = 1; !wake_.wait_for(lock, lease_ / kSignsOfLife, [this] { return ends_; });
       ++sign) {
    lock.unlock();
    try {
      (void)store_.put_text(key(generation_), fmt::format("{} {}\n", holder_, sign));
    } catch (const std::exception&) {
      // The next one may succeed; if none does, others go on with the work.
    }
    lock.lock();
  }
}

void Lease::stop_showing_life() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
  }
  wake_.notify_all();
  if (life_.joinable()) {
    life_.join();
  }
}

void Lease::finish() {
  stop_showing_life();
  std::vector<std::string> keys;
  store_.list(prefix_ + name_ + "/", false, [&](const ListedObject& object) {
    keys.push_back(object.key);
    return true;
  });
  for (const std::string& key : keys) {
    store_.remove(key);
  }
}

void Lease::hand_back() {
  stop_showing_life();
  (void)store_.put_text(key(generation_) + std::string(kBack), holder_ + "\n");
}

Leases::Leases(ObjectStore& store, std::string prefix, std::string holder,
               std::chrono::duration<double> lease)
    : store_(store), prefix_(std::move(prefix)), holder_(std::move(holder)), lease_(lease) {}

void Leases::look() {
  std::map<std::string, Seen> now;
  last_look_ = Clock::now();
  store_.list(prefix_, false, [&](const ListedObject& object) {
    const std::size_t slash = object.key.rfind('/');
    std::string_view last = std::string_view(object.key).substr(slash + 1);
    const bool is_back = last.ends_with(kBack);
    last.remove_suffix(is_back ? kBack.size() : 0);
    int generation = 0;
    std::from_chars(last.data(), last.data() + last.size(), generation);
    if (slash < prefix_.size() || generation < 1) {
      return true;  // not ours
    }
    Seen& seen = now[object.key.substr(prefix_.size(), slash - prefix_.size())];
    seen.returned += is_back ? 1 : 0;
    seen.is_back = is_back && generation >= seen.generation;
    if (generation >= seen.generation && !is_back) {
      seen.etag = object.info.etag;
    }
    seen.generation = std::max(seen.generation, generation);
    return true;
  });
  for (auto& [name, seen] : now) {
    const auto before = seen_.find(name);
    const bool is_same = before != seen_.end() && before->second.generation == seen.generation &&
                         before->second.etag == seen.etag;
    seen.since = is_same ? before->second.since : last_look_;
  }
  seen_ = std::move(now);
}

bool Leases::may_be_free(const std::string& name) const {
  const auto seen = seen_.find(name);
  return seen == seen_.end() || seen->second.is_back || last_look_ - seen->second.since > lease_;
}

std::unique_ptr<Lease> Leases::take(const std::string& name) {
  if (!may_be_free(name)) {
    return nullptr;
  }
  Seen& seen = seen_[name];
  const int generation = seen.generation + 1;
  const std::string key = fmt::format("{}{}/{:06}", prefix_, name, generation);
  const auto etag = store_.put_text(key, holder_ + " 0\n", {.if_absent = true});
  const int abandoned = seen.generation - seen.returned;
  seen = {.generation = generation,
          .returned = seen.returned,
          .etag = etag.value_or(""),
          .since = Clock::now()};
  if (!etag) {
    return nullptr;
  }
  return std::unique_ptr<Lease>(
      new Lease(store_, prefix_, name, generation, abandoned, holder_, lease_));
}

}  // namespace vantage
