#include "engine/io/store/s3_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/checksum.h"
#include "engine/io/files/encoded_text.h"
#include "engine/io/files/random_access_file.h"
#include "engine/io/store/address.h"
#include "engine/io/store/store_answers.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

/// Objects of more are put in parts of at least this; S3 takes 5 MiB at least, and 10,000 parts.
constexpr std::uint64_t kPartBytes = 16U << 20;
constexpr std::uint64_t kMaxParts = 10000;

/// CRC-32 as the header has it: base64 of its bytes, the highest first.
std::string crc32_header(std::span<const std::uint8_t> bytes) {
  const std::uint32_t crc = crc32_of(bytes);
  const std::array<std::uint8_t, 4> digits = {
      static_cast<std::uint8_t>(crc >> 24U), static_cast<std::uint8_t>(crc >> 16U),
      static_cast<std::uint8_t>(crc >> 8U), static_cast<std::uint8_t>(crc)};
  return encode_base64(digits);
}

std::map<std::string, std::string> headers_of(const PutCondition& condition) {
  std::map<std::string, std::string> headers;
  if (condition.if_absent) {
    headers["if-none-match"] = "*";
  } else if (!condition.if_etag.empty()) {
    headers["if-match"] = condition.if_etag;
  }
  return headers;
}

/// Whether the store says that `condition` does not hold; 409: another put is under way.
bool is_refused(const PutCondition& condition, const HttpAnswer& answer) {
  const bool has_condition = condition.if_absent || !condition.if_etag.empty();
  return has_condition && (answer.status == 412 || answer.status == 409 ||
                           element_of(answer.text(), "Code") == "NoSuchKey");
}

/// As libcurl writes it into the header Host, which is signed.
std::string without_usual_port(const std::string& origin) {
  const std::string_view port = origin.starts_with("https:") ? ":443" : ":80";
  return origin.substr(0, origin.size() - (origin.ends_with(port) ? port.size() : 0));
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

ObjectInfo info_of(const HttpAnswer& answer) {
  const std::string range = answer.header("content-range");  // "bytes 0-9/1234"
  const std::string total =
      range.empty() ? answer.header("content-length") : range.substr(range.find('/') + 1);
  ObjectInfo info{.etag = answer.header("etag"), .last_modified = answer.header("last-modified")};
  std::from_chars(total.data(), total.data() + total.size(), info.bytes);
  return info;
}

ObjectPart part_of(HttpAnswer&& answer) {
  ObjectPart part{.info = info_of(answer)};
  const std::string range = answer.header("content-range");
  const std::size_t digits = range.find_first_of("0123456789");
  if (answer.status == 206 && digits != std::string::npos) {
    std::from_chars(range.data() + digits, range.data() + range.size(), part.begin);
  } else {
    part.info.bytes = answer.body.size();
  }
  part.bytes = std::move(answer.body);
  return part;
}

std::string range_header(const ByteRange& range) {
  return fmt::format("bytes={}-{}", range.begin, range.begin + range.count - 1);
}

void fail_changed(const std::string& name) {
  throw Error(fmt::format("{}: has changed since it was begun, expected the same object", name));
}

S3Store::S3Store(std::string bucket, AwsSettings settings, HttpClient& client,
                 AwsCredentials& credentials)
    : bucket_(std::move(bucket)),
      settings_(std::move(settings)),
      client_(client),
      credentials_(credentials) {
  if (settings_.region.empty()) {
    settings_.region = "us-east-1";
  }
  const std::string& region = settings_.region;
  const std::string service =
      fmt::format("s3.{}.amazonaws.com{}", region, region.starts_with("cn-") ? ".cn" : "");
  if (!settings_.endpoint.empty()) {
    if (!settings_.endpoint.starts_with("http")) {
      throw UsageError(fmt::format("AWS_ENDPOINT_URL is '{}', expected https://HOST",
                                   quotable(settings_.endpoint)));
    }
    const Address endpoint = parse_address(settings_.endpoint);
    origin_ = without_usual_port(endpoint.place);
    root_ = fmt::format("{}{}/{}/", endpoint.key.empty() ? "" : "/", endpoint.key, bucket_);
  } else if (bucket_.find('.') != std::string::npos) {  // no certificate names bucket and host
    origin_ = "https://" + service;
    root_ = fmt::format("/{}/", bucket_);
  } else {
    origin_ = fmt::format("https://{}.{}", bucket_, service);
    root_ = "/";
  }
}

std::string S3Store::name_of(const std::string& key) const {
  return fmt::format("s3://{}/{}", bucket_, key);
}

HttpAnswer S3Store::send(const Request& request) {
  return client_.send(name_of(request.key), [&] {
    SignedParts parts{.method = request.method,
                      .host = origin_.substr(origin_.find("://") + 3),
                      .path = root_ + percent_encoded(request.key, "/"),
                      .query = request.query,
                      .headers = request.headers,
                      .body = request.body};
    HttpRequest sent{.method = request.method,
                     .url = origin_ + parts.path,
                     .body = request.body,
                     .max_bytes = request.max_bytes};
    if (!request.query.empty()) {
      sent.url += "?" + encoded_query(request.query);
    }
    if (settings_.is_anonymous) {
      for (const auto& [name, value] : request.headers) {
        sent.headers.push_back(fmt::format("{}: {}", name, value));
      }
    } else {
      sent.headers = signed_headers(parts, credentials_.keys(), settings_.region,
                                    std::chrono::system_clock::now());
    }
    return sent;
  });
}

HttpAnswer S3Store::expect(const Request& request) {
  HttpAnswer answer = send(request);
  if (answer.status < 200 || answer.status >= 300) {
    fail(request, answer);
  }
  return answer;
}

void S3Store::fail(const Request& request, const HttpAnswer& answer) {
  const bool writes = request.method == "PUT" || request.method == "POST";
  throw Error(fmt::format("cannot {} {}: {}", writes ? "write" : "read", name_of(request.key),
                          reason_of(answer, bucket_, origin_, settings_)));
}

std::optional<ObjectInfo> S3Store::info(const std::string& key) {
  const HttpAnswer answer = send({.method = "HEAD", .key = key});
  if (answer.status == 200) {
    return info_of(answer);
  }
  if (answer.status == 404) {
    return std::nullopt;
  }
  // An answer to HEAD tells no reason.
  return read(key, ByteRange{0, 1}, "", 1U << 20).info;
}

ObjectPart S3Store::read(const std::string& key, std::optional<ByteRange> range,
                         const std::string& etag, std::uint64_t max_bytes) {
  Request request{.method = "GET", .key = key, .max_bytes = max_bytes};
  if (range) {
    request.headers["range"] = range_header(*range);
  }
  if (!etag.empty()) {
    request.headers["if-match"] = etag;
  }
  HttpAnswer answer = send(request);
  if (!etag.empty() && (answer.status == 412 || answer.status == 404)) {
    fail_changed(name_of(key));
  }
  if (answer.status != 200 && answer.status != 206) {
    fail(request, answer);
  }
  ObjectPart part = part_of(std::move(answer));
  if (!etag.empty() && part.info.etag != etag) {  // a store that does not know If-Match
    fail_changed(name_of(key));
  }
  return part;
}

std::optional<std::string> S3Store::put(const std::string& key, std::span<const std::uint8_t> bytes,
                                        const PutCondition& condition) {
  Request request{.method = "PUT", .key = key, .headers = headers_of(condition), .body = bytes};
  request.headers["x-amz-checksum-crc32"] = crc32_header(bytes);
  const HttpAnswer answer = send(request);
  if (answer.status == 200) {
    return answer.header("etag");
  }
  if (!is_refused(condition, answer)) {
    fail(request, answer);
  }
  if (answer.attempts > 1) {  // an attempt before may have put it, and its answer was lost
    const std::optional<ObjectInfo> there = info(key);
    if (there && there->bytes == bytes.size() &&
        std::ranges::equal(read(key, {}, there->etag, bytes.size()).bytes, bytes)) {
      return there->etag;
    }
  }
  return std::nullopt;
}

std::string S3Store::put_parts(const std::string& key, const std::string& upload,
                               RandomAccessFile& file) {
  const std::uint64_t size = std::max(kPartBytes, (file.size() + kMaxParts - 1) / kMaxParts);
  std::vector<std::uint8_t> bytes;
  std::string list;
  for (std::uint64_t begin = 0, number = 1; begin < file.size(); begin += size, ++number) {
    bytes.resize(static_cast<std::size_t>(std::min(size, file.size() - begin)));
    bytes.resize(file.read(begin, bytes));
    const std::string crc32 = crc32_header(bytes);
    const HttpAnswer answer =
        expect({.method = "PUT",
                .key = key,
                .query = {{"partNumber", std::to_string(number)}, {"uploadId", upload}},
                .headers = {{"x-amz-checksum-crc32", crc32}},
                .body = bytes});
    list += fmt::format(
        "<Part><PartNumber>{}</PartNumber><ETag>{}</ETag><ChecksumCRC32>{}</ChecksumCRC32></Part>",
        number, escaped_markup(answer.header("etag")), crc32);
  }
  return fmt::format("<CompleteMultipartUpload>{}</CompleteMultipartUpload>", list);
}

std::optional<std::string> S3Store::put_file(const std::string& key,
                                             const std::filesystem::path& file,
                                             const PutCondition& condition) {
  const std::unique_ptr<RandomAccessFile> source = open_random_access(file);
  if (source->size() <= kPartBytes) {
    return ObjectStore::put_file(key, file, condition);
  }
  const HttpAnswer begun = expect({.method = "POST",
                                   .key = key,
                                   .query = {{"uploads", ""}},
                                   .headers = {{"x-amz-checksum-algorithm", "CRC32"}}});
  const std::string upload = element_of(begun.text(), "UploadId");
  const auto abort = [&] {
    (void)send({.method = "DELETE", .key = key, .query = {{"uploadId", upload}}});
  };
  try {
    const std::string parts = put_parts(key, upload, *source);
    const Request request{.method = "POST",
                          .key = key,
                          .query = {{"uploadId", upload}},
                          .headers = headers_of(condition),
                          .body = bytes_of(parts)};
    const HttpAnswer answer = send(request);
    const std::string etag = element_of(answer.text(), "ETag");
    if (answer.status == 200 && !etag.empty()) {  // 200 may come with an error
      return etag;
    }
    if (!is_refused(condition, answer)) {
      fail(request, answer);
    }
  } catch (const Error&) {
    abort();
    throw;
  }
  abort();
  return std::nullopt;
}

void S3Store::list(const std::string& prefix, bool one_level,
                   const std::function<bool(const ListedObject&)>& visit) {
  std::map<std::string, std::string> query = {
      {"encoding-type", "url"}, {"list-type", "2"}, {"prefix", prefix}};
  if (one_level) {
    query["delimiter"] = "/";
  }
  for (bool goes_on = true; goes_on;) {
    const ListedPage page =
        parse_listed_page(expect({.method = "GET", .key = "", .query = query}).text());
    goes_on = std::ranges::all_of(page.objects, visit) && !page.next.empty();
    query["continuation-token"] = page.next;
  }
}

void S3Store::remove(const std::string& key) {
  const Request request{.method = "DELETE", .key = key};
  const HttpAnswer answer = send(request);
  if (answer.status != 204 && answer.status != 200 && answer.status != 404) {
    fail(request, answer);
  }
}

void S3Store::check_writable(const std::string& key) {
  const Request request{.method = "GET",
                        .key = "",
                        .query = {{"list-type", "2"}, {"max-keys", "1"}, {"prefix", key}}};
  const HttpAnswer answer = send(request);
  // Who may write need not be allowed to list.
  if (answer.status != 200 && element_of(answer.text(), "Code") != "AccessDenied") {
    fail(request, answer);
  }
}

}  // namespace vantage
