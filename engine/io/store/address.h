#pragma once

#include <string>
#include <string_view>

namespace vantage {

/// Where an object is.
struct Address {
  bool is_s3 = false;
  std::string place;  ///< the bucket, or "https://host:port"
  /// Of S3: the key, as it is; of others the path, percent-encoded. Without the first slash.
  std::string key;

  /// "s3://bucket" or "https://host:port", and `other_key`.
  [[nodiscard]] std::string with_key(std::string_view other_key) const;
};

/// Parses s3://bucket/key, https://host/path and http://host/path. Parts . and .. of a path are
/// resolved. Throws UsageError, also for a user or password, and for a ?query: results name their
/// inputs, and a query may be a signature.
Address parse_address(const std::string& text);

/// `text` percent-encoded as AWS signs it: all but letters, digits, - . _ ~ and those of `kept`.
std::string percent_encoded(std::string_view text, std::string_view kept);
/// Inverse; what is not encoded stays.
std::string percent_decoded(std::string_view text);

}  // namespace vantage
