#include "engine/io/store/opened_store.h"

#include <fmt/format.h>

#include <utility>

#include "engine/error.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/store/address.h"
#include "engine/io/store/folder_store.h"
#include "engine/io/store/s3_store.h"

namespace vantage {
namespace {

/// A bucket below a prefix, with what it needs to be reached.
class StoreBelow final : public ObjectStore {
 public:
  StoreBelow(const Address& place, std::function<bool()> is_interrupted)
      : client_(std::move(is_interrupted)),
        store_(place.place, aws_settings(), client_, credentials_),
        prefix_(place.key.empty() || place.key.ends_with('/') ? place.key : place.key + '/') {}

  std::optional<ObjectInfo> info(const std::string& key) override {
    return store_.info(prefix_ + key);
  }
  ObjectPart read(const std::string& key, std::optional<ByteRange> range, const std::string& etag,
                  std::uint64_t max_bytes) override {
    return store_.read(prefix_ + key, range, etag, max_bytes);
  }
  std::optional<std::string> put(const std::string& key, std::span<const std::uint8_t> bytes,
                                 const PutCondition& condition) override {
    return store_.put(prefix_ + key, bytes, condition);
  }
  std::optional<std::string> put_file(const std::string& key, const std::filesystem::path& file,
                                      const PutCondition& condition) override {
    return store_.put_file(prefix_ + key, file, condition);
  }
  void list(const std::string& prefix, bool one_level,
            const std::function<bool(const ListedObject&)>& visit) override {
    store_.list(prefix_ + prefix, one_level, [&](const ListedObject& object) {
      ListedObject below = object;
      below.key.erase(0, prefix_.size());
      return visit(below);
    });
  }
  void remove(const std::string& key) override { store_.remove(prefix_ + key); }
  void check_writable(const std::string& key) override { store_.check_writable(prefix_ + key); }

 private:
  HttpClient client_;
  AwsCredentials credentials_{client_};
  S3Store store_;
  std::string prefix_;
};

}  // namespace

std::unique_ptr<ObjectStore> open_store(const std::string& folder,
                                        std::function<bool()> is_interrupted) {
  if (!is_address(folder)) {
    return std::make_unique<FolderStore>(folder);
  }
  const Address place = parse_address(folder);
  if (!place.is_s3) {
    throw UsageError(
        fmt::format("{}: nothing can be written there, expected s3://BUCKET/PREFIX or "
                    "a folder",
                    folder));
  }
  return std::make_unique<StoreBelow>(place, std::move(is_interrupted));
}

}  // namespace vantage
