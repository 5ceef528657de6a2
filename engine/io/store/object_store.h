#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

class HttpClient;

/// What a store says of an object.
struct ObjectInfo {
  std::uint64_t bytes = 0;
  std::string etag = {};           ///< another one once the content is another
  std::string last_modified = {};  ///< as the store writes it; for people
};

/// Bytes `begin` to `begin + count - 1`.
struct ByteRange {
  std::uint64_t begin = 0;
  std::uint64_t count = 0;
};

/// A part of an object.
struct ObjectPart {
  ObjectInfo info;
  std::uint64_t begin = 0;  ///< of `bytes` in the object
  std::vector<std::uint8_t> bytes = {};
};

/// When a put shall replace what is there.
struct PutCondition {
  bool if_absent = false;    ///< only where there is no object
  std::string if_etag = {};  ///< only the object of this ETag; empty: any
};

/// What a listing says of a name: an object, or, of one level, a folder (its key ends in /).
struct ListedObject {
  std::string key;
  ObjectInfo info = {};
  bool is_folder = false;
};

/// Objects of one bucket, server or folder, named by their keys. All functions throw Error naming
/// the object where the store refuses or does not answer, scheduler::Interrupted. Thread rule: may
/// be used concurrently.
class ObjectStore {
 public:
  ObjectStore() = default;
  ObjectStore(const ObjectStore&) = delete;
  ObjectStore& operator=(const ObjectStore&) = delete;
  virtual ~ObjectStore() = default;

  /// Empty where there is no such object.
  virtual std::optional<ObjectInfo> info(const std::string& key) = 0;
  /// The object, or `range` of it: less at its end, more where the store has no ranges. `etag`
  /// (empty: any) must be that of the object; Error that it has changed. Error beyond `max_bytes`.
  virtual ObjectPart read(const std::string& key, std::optional<ByteRange> range,
                          const std::string& etag, std::uint64_t max_bytes) = 0;
  /// Stores the object, which is there whole or not at all; its ETag, empty if `condition` does not
  /// hold. The store compares a checksum.
  virtual std::optional<std::string> put(const std::string& key,
                                         std::span<const std::uint8_t> bytes,
                                         const PutCondition& condition) = 0;
  /// put() of a text.
  std::optional<std::string> put_text(const std::string& key, std::string_view text,
                                      const PutCondition& condition = {}) {
    return put(key, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, condition);
  }
  /// put() of the content of `file`, in parts where it is large.
  virtual std::optional<std::string> put_file(const std::string& key,
                                              const std::filesystem::path& file,
                                              const PutCondition& condition);
  /// All keys that begin with `prefix`, in the order of their bytes; of `one_level`, those without
  /// a further / and the folders. `visit` returns false to end the listing.
  virtual void list(const std::string& prefix, bool one_level,
                    const std::function<bool(const ListedObject&)>& visit) = 0;
  /// Not an error where there is no such object.
  virtual void remove(const std::string& key) = 0;
  /// Throws Error if no such object can be written: no keys, no such bucket, another region.
  virtual void check_writable(const std::string& key) = 0;
};

}  // namespace vantage
