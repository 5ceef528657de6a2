#include "engine/io/store/aws_credentials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/json_text.h"
#include "engine/io/store/store_answers.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;
using std::chrono::system_clock;

/// Answers of services near by come in milliseconds; elsewhere than at AWS there is none.
constexpr std::chrono::milliseconds kServiceLimit{1000};
constexpr std::chrono::minutes kRenewedBefore{5};
constexpr const char* kService = "the service of AWS's keys";

std::string variable(const char* name, const std::string& otherwise = "") {
  const char* const value = std::getenv(name);
  return value == nullptr || *value == '\0' ? otherwise : value;
}

bool is_on(const char* name) {
  const std::string value = variable(name);
  return value == "1" || value == "true" || value == "TRUE" || value == "YES" || value == "yes";
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  return begin == std::string_view::npos
             ? ""
             : text.substr(begin, text.find_last_not_of(" \t\r\n") + 1 - begin);
}

/// Values of the profile in use; those of the file of keys come first.
std::map<std::string, std::string> profile_in_use() {
  const fs::path folder = fs::path(variable("HOME")) / ".aws";
  const std::string profile = variable("AWS_PROFILE", "default");
  std::map<std::string, std::string> values;
  bool is_there = profile == "default";
  for (const fs::path& file :
       {fs::path(variable("AWS_SHARED_CREDENTIALS_FILE", (folder / "credentials").string())),
        fs::path(variable("AWS_CONFIG_FILE", (folder / "config").string()))}) {
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored)) {
      AwsProfiles profiles = parse_aws_profiles(read_file_text(file, true));
      is_there = is_there || profiles.contains(profile);
      values.merge(profiles[profile]);
    }
  }
  if (!is_there) {
    throw Error(fmt::format("AWS_PROFILE is '{}', expected a profile of {}", profile,
                            (folder / "credentials").string()));
  }
  return values;
}

/// "2026-11-28T18:00:00Z".
std::optional<system_clock::time_point> time_of(const std::string& text) {
  std::tm parts{};
  return ::strptime(text.c_str(), "%Y-%m-%dT%H:%M:%S", &parts) == nullptr
             ? std::nullopt
             : std::optional(system_clock::from_time_t(::timegm(&parts)));
}

}  // namespace

AwsProfiles parse_aws_profiles(std::string_view text) {
  AwsProfiles profiles;
  std::string name;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string_view content = trimmed(line);
    const std::size_t equals = content.find('=');
    if (content.starts_with('[') && content.ends_with(']')) {
      std::string_view section = trimmed(content.substr(1, content.size() - 2));
      section = section.starts_with("profile ") ? trimmed(section.substr(8)) : section;
      name = section;
      profiles[name];
    } else if (!content.starts_with('#') && !line.starts_with(' ') && !line.starts_with('\t') &&
               equals != std::string_view::npos) {  // indented lines are of another service
      profiles[name][std::string(trimmed(content.substr(0, equals)))] =
          trimmed(content.substr(equals + 1));
    }
  }
  return profiles;
}

AwsSettings aws_settings() {
  std::map<std::string, std::string> profile = profile_in_use();
  AwsSettings settings;
  settings.region = variable("AWS_REGION", variable("AWS_DEFAULT_REGION", profile["region"]));
  settings.endpoint =
      variable("AWS_ENDPOINT_URL_S3", variable("AWS_ENDPOINT_URL", profile["endpoint_url"]));
  while (settings.endpoint.ends_with('/')) {
    settings.endpoint.pop_back();
  }
  settings.is_anonymous = is_on("AWS_NO_SIGN_REQUEST");
  return settings;
}

AwsKeys AwsCredentials::keys() {
  const std::scoped_lock lock(mutex_);
  if (!found_ || (found_->expires && *found_->expires - kRenewedBefore < system_clock::now())) {
    found_ = find();
  }
  if (!found_) {
    throw Error(
        "there are no keys for S3, expected AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY, a profile "
        "in ~/.aws/credentials, or the service of a container or machine at AWS; "
        "AWS_NO_SIGN_REQUEST=1 reads public data");
  }
  return found_->keys;
}

void AwsCredentials::forget() {
  const std::scoped_lock lock(mutex_);
  if (found_ && !found_->expires) {
    found_.reset();
  }
}

std::optional<AwsCredentials::Found> AwsCredentials::find() {
  const AwsKeys of_variables{variable("AWS_ACCESS_KEY_ID"), variable("AWS_SECRET_ACCESS_KEY"),
                             variable("AWS_SESSION_TOKEN")};
  if (!of_variables.id.empty() && !of_variables.secret.empty()) {
    return Found{of_variables, {}};
  }
  if (std::optional<Found> found = of_web_identity()) {
    return found;
  }
  std::map<std::string, std::string> profile = profile_in_use();
  const AwsKeys of_profile{profile["aws_access_key_id"], profile["aws_secret_access_key"],
                           profile["aws_session_token"]};
  if (!of_profile.id.empty() && !of_profile.secret.empty()) {
    return Found{of_profile, {}};
  }
  std::optional<Found> found = of_container();
  return found ? found : of_machine();
}

std::optional<AwsCredentials::Found> AwsCredentials::of_web_identity() {
  const std::string role = variable("AWS_ROLE_ARN");
  const std::string file = variable("AWS_WEB_IDENTITY_TOKEN_FILE");
  if (role.empty() || file.empty()) {
    return std::nullopt;
  }
  const std::string region = variable("AWS_REGION", variable("AWS_DEFAULT_REGION", "us-east-1"));
  const std::string service =
      variable("AWS_ENDPOINT_URL_STS", fmt::format("https://sts.{}.amazonaws.com", region));
  const std::string query =
      encoded_query({{"Action", "AssumeRoleWithWebIdentity"},
                     {"RoleArn", role},
                     {"RoleSessionName", variable("AWS_ROLE_SESSION_NAME", "vantage")},
                     {"Version", "2011-06-15"},
                     {"WebIdentityToken", std::string(trimmed(read_file_text(file)))}});
  const HttpAnswer answer = client_.send(
      kService, [&] { return HttpRequest{.url = fmt::format("{}/?{}", service, query)}; });
  const std::string xml = answer.text();
  return checked({{element_of(xml, "AccessKeyId"), element_of(xml, "SecretAccessKey"),
                   element_of(xml, "SessionToken")},
                  time_of(element_of(xml, "Expiration"))},
                 answer.status);
}

std::optional<AwsCredentials::Found> AwsCredentials::of_container() {
  const std::string relative = variable("AWS_CONTAINER_CREDENTIALS_RELATIVE_URI");
  const std::string address = relative.empty() ? variable("AWS_CONTAINER_CREDENTIALS_FULL_URI")
                                               : "http://169.254.170.2" + relative;
  if (address.empty()) {
    return std::nullopt;
  }
  HttpRequest request{.url = address};
  std::string token = variable("AWS_CONTAINER_AUTHORIZATION_TOKEN");
  if (const std::string file = variable("AWS_CONTAINER_AUTHORIZATION_TOKEN_FILE"); !file.empty()) {
    token = trimmed(read_file_text(file).c_str());
  }
  if (!token.empty()) {
    request.headers.push_back("Authorization: " + token);
  }
  return fetch(request);
}

std::optional<AwsCredentials::Found> AwsCredentials::of_machine() {
  if (is_on("AWS_EC2_METADATA_DISABLED")) {
    return std::nullopt;
  }
  const std::string service =
      variable("AWS_EC2_METADATA_SERVICE_ENDPOINT", "http://169.254.169.254") + "/latest";
  try {
    const HttpAnswer token =
        client_.ask_service({.method = "PUT",
                             .url = service + "/api/token",
                             .headers = {"X-aws-ec2-metadata-token-ttl-seconds: 21600"}},
                            kServiceLimit);
    HttpRequest request{.url = service + "/meta-data/iam/security-credentials/",
                        .headers = {"X-aws-ec2-metadata-token: " + token.text()}};
    const HttpAnswer role = client_.ask_service(request, kServiceLimit);
    if (token.status != 200 || role.status != 200) {
      return std::nullopt;
    }
    request.url += trimmed(role.text().c_str());
    return fetch(request);
  } catch (const Error&) {
    return std::nullopt;  // not a machine at AWS
  }
}

AwsCredentials::Found AwsCredentials::fetch(const HttpRequest& request) {
  const HttpAnswer answer = client_.ask_service(request, kServiceLimit);
  const nlohmann::ordered_json json =
      answer.status == 200 ? parse_json(answer.text(), kService) : nlohmann::ordered_json();
  const auto text = [&](const char* name) {
    const auto found = json.find(name);
    return found != json.end() && found->is_string() ? found->get<std::string>() : "";
  };
  return checked(
      {{text("AccessKeyId"), text("SecretAccessKey"), text("Token")}, time_of(text("Expiration"))},
      answer.status);
}

AwsCredentials::Found AwsCredentials::checked(Found found, int status) {
  if (found.keys.id.empty() || found.keys.secret.empty()) {
    throw Error(fmt::format("{} answers {}, expected keys", kService, status));
  }
  return found;
}

}  // namespace vantage
