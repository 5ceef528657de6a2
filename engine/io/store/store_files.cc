#include "engine/io/store/store_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "engine/error.h"
#include "engine/io/store/address.h"
#include "engine/io/store/aws_credentials.h"
#include "engine/io/store/block_reader.h"
#include "engine/io/store/http_client.h"
#include "engine/io/store/http_store.h"
#include "engine/io/store/read_ahead.h"
#include "engine/io/store/s3_store.h"

namespace vantage {
namespace {

/// Of the last films opened: they are opened several times, and their ends read each time.
constexpr std::size_t kKeptReaders = 4;
/// About 200 bytes each.
constexpr std::size_t kMaxKnown = 500'000;
/// As of the largest file that is read whole.
constexpr std::uint64_t kMaxAheadBytes = 1ULL << 33;

class OpenedObject final : public RandomAccessFile {
 public:
  explicit OpenedObject(std::shared_ptr<BlockReader> reader) : reader_(std::move(reader)) {}
  [[nodiscard]] std::uint64_t size() const override { return reader_->info().bytes; }
  std::size_t read(std::uint64_t offset, std::span<std::uint8_t> bytes) override {
    return reader_->read(offset, bytes);
  }

 private:
  std::shared_ptr<BlockReader> reader_;
};

class StoreFiles final : public RemoteFiles {
 public:
  explicit StoreFiles(std::function<bool()> is_interrupted) : client_(std::move(is_interrupted)) {}

  std::optional<FileStatus> status(const std::string& address) override {
    const Address place = parse_address(address);
    if (!place.key.empty() && !place.key.ends_with('/')) {
      if (const std::optional<ObjectInfo> info = info_of_object(place)) {
        return FileStatus{.bytes = info->bytes, .version = info->etag};
      }
    }
    return place.is_s3 && is_prefix(place) ? std::optional(FileStatus{.is_folder = true})
                                           : std::nullopt;
  }

  std::vector<std::uint8_t> read(const std::string& address, std::uint64_t max_bytes) override {
    std::optional<std::vector<std::uint8_t>> fetched = ahead_.take(address);
    return fetched ? std::move(*fetched) : read_now(address, max_bytes);
  }

  void read_ahead(const std::string& address) override { ahead_.begin(address); }

  std::vector<std::uint8_t> read_now(const std::string& address, std::uint64_t max_bytes) {
    const Address place = parse_address(address);
    const std::optional<ObjectInfo> before = known(place);
    ObjectPart part = store_of(place)->read(place.key, {}, before ? before->etag : "", max_bytes);
    note(place, part.info);
    return std::move(part.bytes);
  }

  std::unique_ptr<RandomAccessFile> open(const std::string& address) override {
    const Address place = parse_address(address);
    const std::optional<ObjectInfo> info = info_of_object(place);
    if (!info) {
      throw Error(fmt::format("cannot read {}: no such file", address));
    }
    const std::scoped_lock lock(mutex_);
    const std::string name = place.with_key(place.key);
    const auto opened =
        std::ranges::find(readers_, name, [](const auto& entry) { return entry.first; });
    if (opened != readers_.end() && opened->second->info().etag == info->etag) {
      readers_.splice(readers_.begin(), readers_, opened);
    } else {
      readers_.emplace_front(
          name, std::make_shared<BlockReader>(store_in_lock(place), place.key, *info, client_));
      readers_.resize(std::min(readers_.size(), kKeptReaders));
    }
    return std::make_unique<OpenedObject>(readers_.front().second);
  }

  std::vector<std::string> names(const std::string& folder) override {
    Address place = parse_address(folder);
    place.key = prefix_of(place);
    std::vector<std::string> names;
    store_of(place)->list(place.key, true, [&](const ListedObject& object) {
      if (!object.is_folder && object.key.size() > place.key.size()) {
        names.push_back(object.key.substr(place.key.size()));
        note({place.is_s3, place.place, object.key}, object.info);
      }
      return true;
    });
    return names;
  }

  void check_writable(const std::string& address) override {
    const Address place = parse_address(address);
    if (place.key.empty() || place.key.ends_with('/')) {
      throw UsageError(fmt::format("{}: names no object, expected s3://BUCKET/KEY", address));
    }
    store_of(place)->check_writable(place.key);
  }

  bool write(const std::string& address, const std::filesystem::path& file,
             bool if_absent) override {
    const Address place = parse_address(address);
    const bool is_written =
        store_of(place)->put_file(place.key, file, {.if_absent = if_absent}).has_value();
    const std::scoped_lock lock(mutex_);
    known_.erase(place.with_key(place.key));
    return is_written;
  }

  void forget() override {
    const std::scoped_lock lock(mutex_);
    known_.clear();
    readers_.clear();
    stores_.clear();
    credentials_.forget();
  }

 private:
  static std::string prefix_of(const Address& place) {
    return place.key.empty() || place.key.ends_with('/') ? place.key : place.key + '/';
  }

  bool is_prefix(const Address& place) {
    bool is_prefix = false;
    store_of(place)->list(prefix_of(place), true, [&](const ListedObject&) {
      is_prefix = true;
      return false;
    });
    return is_prefix;
  }

  std::shared_ptr<ObjectStore> store_of(const Address& place) {
    const std::scoped_lock lock(mutex_);
    return store_in_lock(place);
  }

  std::shared_ptr<ObjectStore> store_in_lock(const Address& place) {
    std::shared_ptr<ObjectStore>& store = stores_[place.with_key("")];
    if (store == nullptr && place.is_s3) {
      store = std::make_shared<S3Store>(place.place, aws_settings(), client_, credentials_);
    } else if (store == nullptr) {
      store = std::make_shared<HttpStore>(place.place, client_);
    }
    return store;
  }

  std::optional<ObjectInfo> known(const Address& place) {
    const std::scoped_lock lock(mutex_);
    const auto found = known_.find(place.with_key(place.key));
    return found == known_.end() ? std::nullopt : std::optional(found->second);
  }

  void note(const Address& place, const ObjectInfo& info) {
    const std::scoped_lock lock(mutex_);
    if (known_.size() < kMaxKnown) {
      known_.try_emplace(place.with_key(place.key), info);
    }
  }

  std::optional<ObjectInfo> info_of_object(const Address& place) {
    std::optional<ObjectInfo> info = known(place);
    if (!info && (info = store_of(place)->info(place.key))) {
      note(place, *info);
    }
    return info;
  }

  HttpClient client_;
  AwsCredentials credentials_{client_};
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<ObjectStore>> stores_;
  std::map<std::string, ObjectInfo> known_;
  std::list<std::pair<std::string, std::shared_ptr<BlockReader>>> readers_;
  /// Last: its requests use the others.
  ReadAhead ahead_{
      [this](const std::string& address) { return read_now(address, kMaxAheadBytes); }};
};

}  // namespace

std::unique_ptr<RemoteFiles> make_store_files(std::function<bool()> is_interrupted) {
  return std::make_unique<StoreFiles>(std::move(is_interrupted));
}

}  // namespace vantage
