#pragma once

#include <filesystem>
#include <string>

#include "engine/io/store/object_store.h"

namespace vantage {

/// A folder of this machine, or of a file system that several share, as a store: keys are relative
/// paths. An ETag is made of size, time of change and number of the file.
class FolderStore final : public ObjectStore {
 public:
  explicit FolderStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::optional<ObjectInfo> info(const std::string& key) override;
  ObjectPart read(const std::string& key, std::optional<ByteRange> range, const std::string& etag,
                  std::uint64_t max_bytes) override;
  /// Of several processes that put if absent, one succeeds. if_etag compares and replaces under a
  /// lock on the folder of the file, on file systems that have locks.
  std::optional<std::string> put(const std::string& key, std::span<const std::uint8_t> bytes,
                                 const PutCondition& condition) override;
  void list(const std::string& prefix, bool one_level,
            const std::function<bool(const ListedObject&)>& visit) override;
  void remove(const std::string& key) override;
  void check_writable(const std::string& key) override;

 private:
  std::filesystem::path folder_;
};

}  // namespace vantage
