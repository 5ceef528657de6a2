#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "engine/io/store/http_client.h"
#include "engine/io/store/object_store.h"

namespace vantage {

/// Reads an object in blocks of 4 MiB, of which it keeps the last 4. Once blocks are read in order,
/// the next one is fetched by another thread meanwhile. Thread rule: may be used concurrently.
class BlockReader {
 public:
  /// `info` must be that of the object, which is not to change. `client` must outlive this object.
  BlockReader(std::shared_ptr<ObjectStore> store, std::string key, ObjectInfo info,
              const HttpClient& client);
  BlockReader(const BlockReader&) = delete;
  BlockReader& operator=(const BlockReader&) = delete;
  ~BlockReader();

  [[nodiscard]] const ObjectInfo& info() const { return info_; }
  /// As RandomAccessFile::read(). Throws Error naming the object, scheduler::Interrupted.
  std::size_t read(std::uint64_t offset, std::span<std::uint8_t> bytes);

 private:
  struct Ahead {
    std::uint64_t index = 0;
    std::future<ObjectPart> part;
  };
  /// The block that holds byte `place`.
  const ObjectPart& block_with(std::uint64_t place);
  ObjectPart fetch(std::uint64_t index);
  ObjectPart take_ahead();

  std::shared_ptr<ObjectStore> store_;
  std::string key_;
  ObjectInfo info_;
  const HttpClient& client_;
  std::mutex mutex_;
  std::list<ObjectPart> blocks_;  ///< the last used one first
  std::atomic<bool> is_cancelled_ = false;
  std::optional<Ahead> ahead_;
};

}  // namespace vantage
