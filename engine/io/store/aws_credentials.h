#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "engine/io/store/http_client.h"
#include "engine/io/store/signature.h"

namespace vantage {

/// Sections of ~/.aws/credentials and ~/.aws/config: name → key → value. "[profile a]" is "a".
using AwsProfiles = std::map<std::string, std::map<std::string, std::string>>;
/// Lines that are neither are passed over, as AWS's programs do. Thread rule: pure.
AwsProfiles parse_aws_profiles(std::string_view text);

/// How stores are reached, from the variables and files of AWS's programs.
struct AwsSettings {
  std::string region = {};  ///< AWS_REGION, AWS_DEFAULT_REGION, of the profile; empty: none is set
  std::string endpoint = {};  ///< AWS_ENDPOINT_URL_S3, AWS_ENDPOINT_URL, of the profile; empty: AWS
  bool is_anonymous = false;  ///< AWS_NO_SIGN_REQUEST: public data is read without keys
};
AwsSettings aws_settings();

/// The keys of this process, from the first of these that has some: AWS_ACCESS_KEY_ID and its
/// companions; the role AWS_ROLE_ARN, for the token in AWS_WEB_IDENTITY_TOKEN_FILE (Kubernetes at
/// AWS); the profile AWS_PROFILE of ~/.aws/credentials and ~/.aws/config; the service of a
/// container; that of a machine at AWS (IMDSv2). Those that expire are fetched again 5 minutes
/// before. Thread rule: may be used concurrently.
class AwsCredentials {
 public:
  /// `client` must outlive this object.
  explicit AwsCredentials(HttpClient& client) : client_(client) {}

  /// Throws Error that says where keys were looked for.
  AwsKeys keys();
  /// Those of variables and files are read again next time.
  void forget();

 private:
  struct Found {
    AwsKeys keys;
    std::optional<std::chrono::system_clock::time_point> expires;
  };
  std::optional<Found> find();
  std::optional<Found> of_web_identity();
  std::optional<Found> of_container();
  std::optional<Found> of_machine();
  Found fetch(const HttpRequest& request);
  /// Throws Error unless there are keys in an answer of this `status`.
  static Found checked(Found found, int status);

  HttpClient& client_;
  std::mutex mutex_;
  std::optional<Found> found_;
};

}  // namespace vantage
