#pragma once

#include <map>
#include <memory>
#include <string>

#include "engine/io/files/random_access_file.h"
#include "engine/io/store/aws_credentials.h"
#include "engine/io/store/http_client.h"
#include "engine/io/store/object_store.h"

namespace vantage {

/// A bucket of S3, or of another store that speaks its protocol.
class S3Store final : public ObjectStore {
 public:
  /// `client` and `credentials` must outlive this object.
  S3Store(std::string bucket, AwsSettings settings, HttpClient& client,
          AwsCredentials& credentials);

  std::optional<ObjectInfo> info(const std::string& key) override;
  ObjectPart read(const std::string& key, std::optional<ByteRange> range, const std::string& etag,
                  std::uint64_t max_bytes) override;
  std::optional<std::string> put(const std::string& key, std::span<const std::uint8_t> bytes,
                                 const PutCondition& condition) override;
  std::optional<std::string> put_file(const std::string& key, const std::filesystem::path& file,
                                      const PutCondition& condition) override;
  void list(const std::string& prefix, bool one_level,
            const std::function<bool(const ListedObject&)>& visit) override;
  void remove(const std::string& key) override;
  void check_writable(const std::string& key) override;

 private:
  struct Request {
    std::string method;
    std::string key;
    std::map<std::string, std::string> query = {};
    std::map<std::string, std::string> headers = {};
    std::span<const std::uint8_t> body = {};
    std::uint64_t max_bytes = 16U << 20;
  };
  HttpAnswer send(const Request& request);
  /// As send(); fail() where the store refuses.
  HttpAnswer expect(const Request& request);
  [[noreturn]] void fail(const Request& request, const HttpAnswer& answer);
  [[nodiscard]] std::string name_of(const std::string& key) const;
  /// Puts the parts of a large object; the list of them that ends the upload.
  std::string put_parts(const std::string& key, const std::string& upload, RandomAccessFile& file);

  std::string bucket_;
  AwsSettings settings_;
  std::string origin_;  ///< "https://host"
  std::string root_;    ///< of paths: "/" or "/bucket/"
  HttpClient& client_;
  AwsCredentials& credentials_;
};

/// What the headers of an answer say of its object.
ObjectInfo info_of(const HttpAnswer& answer);
/// read() from the answer to a request for `range`, whose status is 200 or 206.
ObjectPart part_of(HttpAnswer&& answer);
/// The value of the header Range.
std::string range_header(const ByteRange& range);
/// Error of read(): the object is no longer the one that was begun.
[[noreturn]] void fail_changed(const std::string& name);

}  // namespace vantage
