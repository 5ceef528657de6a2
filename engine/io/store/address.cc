#include "engine/io/store/address.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <regex>
#include <vector>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr std::string_view kUnreserved =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
/// What a path of an URL may hold beside them; % is what the user has encoded.
constexpr std::string_view kOfPath = "/!$&'()*+,;=:@%";

/// Lists name files as "../right/1.png", relative to their own address.
std::string without_dots(std::string_view path) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const std::string_view part = path.substr(begin, end - begin);
    if (part == "..") {
      parts.resize(parts.size() - (parts.empty() ? 0 : 1));
    } else if (part != ".") {
      parts.push_back(part);
    }
    begin = end + 1;
  }
  return fmt::format("{}", fmt::join(parts, "/"));
}

}  // namespace

std::string Address::with_key(std::string_view other_key) const {
  return fmt::format("{}{}/{}", is_s3 ? "s3://" : "", place, other_key);
}

Address parse_address(const std::string& text) {
  const std::size_t begin = text.find("://") + 3;
  const std::size_t slash = std::min(text.find('/', begin), text.size());
  const std::string host = text.substr(begin, slash - begin);
  const std::string path =
      without_dots(std::string_view(text).substr(std::min(slash + 1, text.size())));
  if (host.find('@') != std::string::npos) {
    throw UsageError(
        "an address holds a user or password, expected s3://BUCKET/KEY or "
        "https://HOST/PATH; keys are read from AWS's files and variables");
  }
  const bool is_s3 = text.starts_with("s3://");
  // Of a password with a slash, no part becomes a host.
  static const std::regex bucket("[A-Za-z0-9._-]+");
  static const std::regex server("([A-Za-z0-9._-]+|\\[[0-9A-Fa-f:.]+\\])(:[0-9]{1,5})?");
  if (!std::regex_match(host, is_s3 ? bucket : server)) {
    throw UsageError(fmt::format("{}... is no address, expected {}", text.substr(0, begin),
                                 is_s3 ? "s3://BUCKET/KEY" : "https://HOST/PATH"));
  }
  if (!is_s3 && path.find('?') != std::string::npos) {
    throw UsageError(
        fmt::format("{}: has a query, expected an address without one: results name "
                    "their inputs, and queries hold signatures",
                    text.substr(0, text.find('?'))));
  }
  return is_s3 ? Address{true, host, path}
               : Address{false, text.substr(0, slash), percent_encoded(path, kOfPath)};
}

std::string percent_encoded(std::string_view text, std::string_view kept) {
  std::string encoded;
  for (const char letter : text) {
    if (kUnreserved.find(letter) != std::string_view::npos ||
        kept.find(letter) != std::string_view::npos) {
      encoded += letter;
    } else {
      encoded += fmt::format("%{:02X}", static_cast<unsigned char>(letter));
    }
  }
  return encoded;
}

std::string percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned value = 0;
    const char* const digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(digits, digits + 2, value, 16).ptr == digits + 2) {
      decoded += static_cast<char>(value);
      i += 2;
    } else {
      decoded += text[i];
    }
  }
  return decoded;
}

}  // namespace vantage
