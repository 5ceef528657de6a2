#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Keys of AWS, or of another store that speaks S3.
struct AwsKeys {
  std::string id;
  std::string secret;
  std::string session_token;  ///< empty: none
};

/// A request to S3 before it is signed.
struct SignedParts {
  std::string method;
  std::string host;                            ///< as the Host header has it
  std::string path;                            ///< percent-encoded, from the first slash on
  std::map<std::string, std::string> query;    ///< not encoded
  std::map<std::string, std::string> headers;  ///< to be signed; names in lower case
  std::span<const std::uint8_t> body;
};

/// The query as it is sent and signed: names sorted, all encoded; without the question mark.
std::string encoded_query(const std::map<std::string, std::string>& query);

/// The headers of `parts`, "name: value", with those of AWS Signature Version 4 for the service s3.
/// Ours, because the one of libcurl 7.88 signs queries and paths as they are written, not as AWS
/// sorts and encodes them. Thread rule: may be used concurrently. Throws Error where the library of
/// SHA-256 is missing.
std::vector<std::string> signed_headers(const SignedParts& parts, const AwsKeys& keys,
                                        const std::string& region,
                                        std::chrono::system_clock::time_point time);

}  // namespace vantage
