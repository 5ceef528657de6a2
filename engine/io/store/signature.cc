#include "engine/io/store/signature.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "engine/io/store/address.h"
#include "engine/late_library.h"

namespace vantage {
namespace {

using Digest = std::array<std::uint8_t, 32>;
constexpr const char* kAlgorithm = "AWS4-HMAC-SHA256";

/// OpenSSL's, which libcurl brings. The types are of its binary interface, which is stable.
struct Sha256 {
  LateLibrary library{"libcrypto.so.3", "cannot sign requests to S3 (Debian: libssl3)"};
  using Type = unsigned char* (*)(const unsigned char*, std::size_t, unsigned char*);
  Type function = library.function<Type>("SHA256");
};

Digest sha256(std::string_view bytes) {
  static const Sha256 library;
  Digest digest{};
  library.function(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
                   digest.data());
  return digest;
}

std::string_view view_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string hexadecimal(const Digest& digest) {
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

/// HMAC of SHA-256 (RFC 2104).
Digest hmac(std::string_view key, std::string_view text) {
  constexpr std::size_t kHashedBytes = 64;
  std::string padded(key.size() > kHashedBytes ? view_of(sha256(key)) : key);
  padded.resize(kHashedBytes, '\0');
  const auto keyed = [&](char pad, std::string_view rest) {
    std::string bytes = padded;
    for (char& byte : bytes) {
      byte = static_cast<char>(byte ^ pad);
    }
    return sha256(bytes.append(rest));
  };
  return keyed('\x5c', view_of(keyed('\x36', text)));
}

}  // namespace

std::string encoded_query(const std::map<std::string, std::string>& query) {
  std::vector<std::string> parts;
  for (const auto& [name, value] : query) {  // all names are letters and dashes, so in order
    parts.push_back(fmt::format("{}={}", percent_encoded(name, ""), percent_encoded(value, "")));
  }
  return fmt::format("{}", fmt::join(parts, "&"));
}

std::vector<std::string> signed_headers(const SignedParts& parts, const AwsKeys& keys,
                                        const std::string& region,
                                        std::chrono::system_clock::time_point time) {
  const std::string moment =
      fmt::format("{:%Y%m%dT%H%M%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
  const std::string day = moment.substr(0, moment.find('T'));
  const std::string content = hexadecimal(sha256(view_of(parts.body)));
  std::map<std::string, std::string> headers = parts.headers;
  headers["x-amz-content-sha256"] = content;
  headers["x-amz-date"] = moment;
  if (!keys.session_token.empty()) {
    headers["x-amz-security-token"] = keys.session_token;
  }
  std::vector<std::string> lines;
  for (const auto& [name, value] : headers) {
    lines.push_back(fmt::format("{}: {}", name, value));
  }
  headers["host"] = parts.host;  // libcurl writes it
  std::vector<std::string> names;
  std::string canonical;
  for (const auto& [name, value] : headers) {
    names.push_back(name);
    canonical += fmt::format("{}:{}\n", name, value);
  }
  const std::string signed_names = fmt::format("{}", fmt::join(names, ";"));
  const std::string request =
      fmt::format("{}\n{}\n{}\n{}\n{}\n{}", parts.method, parts.path, encoded_query(parts.query),
                  canonical, signed_names, content);
  const std::string scope = fmt::format("{}/{}/s3/aws4_request", day, region);
  const std::string text =
      fmt::format("{}\n{}\n{}\n{}", kAlgorithm, moment, scope, hexadecimal(sha256(request)));
  Digest key = hmac("AWS4" + keys.secret, day);
  for (const std::string_view step :
       {std::string_view(region), std::string_view("s3"), std::string_view("aws4_request")}) {
    key = hmac(view_of(key), step);
  }
  lines.push_back(fmt::format("Authorization: {} Credential={}/{}, SignedHeaders={}, Signature={}",
                              kAlgorithm, keys.id, scope, signed_names,
                              hexadecimal(hmac(view_of(key), text))));
  return lines;
}

}  // namespace vantage
