#pragma once

#include <string>

#include "engine/io/store/http_client.h"
#include "engine/io/store/object_store.h"

namespace vantage {

/// What a server of the web holds. Read only, without listings.
class HttpStore final : public ObjectStore {
 public:
  /// `origin`: "https://host". `client` must outlive this object.
  HttpStore(std::string origin, HttpClient& client);

  std::optional<ObjectInfo> info(const std::string& key) override;
  ObjectPart read(const std::string& key, std::optional<ByteRange> range, const std::string& etag,
                  std::uint64_t max_bytes) override;
  std::optional<std::string> put(const std::string& key, std::span<const std::uint8_t> bytes,
                                 const PutCondition& condition) override;
  void list(const std::string& prefix, bool one_level,
            const std::function<bool(const ListedObject&)>& visit) override;
  void remove(const std::string& key) override;
  void check_writable(const std::string& key) override;

 private:
  HttpAnswer send(const HttpRequest& request, const std::string& key);
  [[noreturn]] void fail(const std::string& key, const std::string& problem) const;

  std::string origin_;
  HttpClient& client_;
};

}  // namespace vantage
