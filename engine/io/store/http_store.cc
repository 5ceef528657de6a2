#include "engine/io/store/http_store.h"

#include <fmt/format.h>

#include <utility>

#include "engine/error.h"
#include "engine/io/store/s3_store.h"

namespace vantage {
namespace {

/// Servers without ETags tell at least when a file was changed.
void complete_etag(ObjectInfo& info) {
  if (info.etag.empty()) {
    info.etag = info.last_modified;
  }
}

}  // namespace

HttpStore::HttpStore(std::string origin, HttpClient& client)
    : origin_(std::move(origin)), client_(client) {}

void HttpStore::fail(const std::string& key, const std::string& problem) const {
  throw Error(fmt::format("{}/{}: {}", origin_, key, problem));
}

HttpAnswer HttpStore::send(const HttpRequest& request, const std::string& key) {
  HttpAnswer answer = client_.send(fmt::format("{}/{}", origin_, key), [&] { return request; });
  const int status = answer.status;
  if (status != 200 && status != 206 && status != 404 && status != 410) {
    fail(key, status == 401 || status == 403
                  ? "access is denied"
                  : fmt::format("its server answers {}, expected a file", status));
  }
  return answer;
}

std::optional<ObjectInfo> HttpStore::info(const std::string& key) {
  const HttpAnswer answer =
      send({.method = "HEAD", .url = fmt::format("{}/{}", origin_, key), .follows_redirects = true},
           key);
  if (answer.status >= 400) {
    return std::nullopt;
  }
  ObjectInfo info = info_of(answer);
  complete_etag(info);
  return info;
}

ObjectPart HttpStore::read(const std::string& key, std::optional<ByteRange> range,
                           const std::string& etag, std::uint64_t max_bytes) {
  HttpRequest request{
      .url = fmt::format("{}/{}", origin_, key), .max_bytes = max_bytes, .follows_redirects = true};
  if (range) {
    request.headers.push_back("Range: " + range_header(*range));
  }
  HttpAnswer answer = send(request, key);
  if (answer.status >= 400) {
    fail(key, "no such file");
  }
  ObjectPart part = part_of(std::move(answer));
  complete_etag(part.info);
  // If-Match would fail with weak ETags, which many servers have.
  if (!etag.empty() && part.info.etag != etag) {
    fail_changed(fmt::format("{}/{}", origin_, key));
  }
  return part;
}

std::optional<std::string> HttpStore::put(const std::string& key, std::span<const std::uint8_t>,
                                          const PutCondition&) {
  fail(key, "cannot be written, expected a local file or s3://BUCKET/KEY");
}

void HttpStore::list(const std::string& prefix, bool,
                     const std::function<bool(const ListedObject&)>&) {
  fail(prefix, "no such file, and servers of the web have no listings; s3:// has");
}

void HttpStore::remove(const std::string& key) { fail(key, "cannot be removed"); }

void HttpStore::check_writable(const std::string& key) {
  fail(key, "cannot be written, expected a local file or s3://BUCKET/KEY");
}

}  // namespace vantage
