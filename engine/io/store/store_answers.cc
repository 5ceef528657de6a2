#include "engine/io/store/store_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <utility>

#include "engine/io/store/address.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

/// The content of the next element `name` of `xml`, which is shortened to what follows it.
std::optional<std::string_view> take_element(std::string_view& xml, std::string_view name) {
  const std::string opening = fmt::format("<{}>", name);
  const std::string closing = fmt::format("</{}>", name);
  const std::size_t begin = xml.find(opening);
  const std::size_t end = begin == std::string_view::npos ? begin : xml.find(closing, begin);
  if (end == std::string_view::npos) {
    return std::nullopt;
  }
  const std::string_view content = xml.substr(begin + opening.size(), end - begin - opening.size());
  xml.remove_prefix(end + closing.size());
  return content;
}

std::string unescaped(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 6> kEntities = {{{"&lt;", '<'},
                                                                           {"&gt;", '>'},
                                                                           {"&quot;", '"'},
                                                                           {"&#34;", '"'},
                                                                           {"&apos;", '\''},
                                                                           {"&amp;", '&'}}};
  std::string plain;
  while (!text.empty()) {
    const auto entity = std::ranges::find_if(
        kEntities, [&](const auto& known) { return text.starts_with(known.first); });
    const bool is_entity = entity != kEntities.end();
    plain += is_entity ? entity->second : text.front();
    text.remove_prefix(is_entity ? entity->first.size() : 1);
  }
  return plain;
}

std::uint64_t number_of(const std::string& text) {
  std::uint64_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

/// "12 min behind", from the time of the store's answer.
std::string clock_error(const HttpAnswer& answer) {
  std::tm parts{};
  if (::strptime(answer.header("date").c_str(), "%a, %d %b %Y %H:%M:%S", &parts) == nullptr) {
    return "off";
  }
  const auto off_s = static_cast<long>(std::time(nullptr) - ::timegm(&parts));
  return fmt::format("{} min {} the store's", (std::abs(off_s) + 30) / 60,
                     off_s < 0 ? "behind" : "ahead of");
}

}  // namespace

std::string element_of(std::string_view xml, std::string_view name) {
  return unescaped(take_element(xml, name).value_or(""));
}

std::string reason_of(const HttpAnswer& answer, const std::string& bucket,
                      const std::string& origin, const AwsSettings& settings) {
  const std::string xml = answer.text();
  const std::string code = element_of(xml, "Code");
  const std::string told_region = element_of(xml, "Region");
  const std::string region =
      told_region.empty() ? answer.header("x-amz-bucket-region") : told_region;
  if (!region.empty() && region != settings.region) {
    return fmt::format("its bucket is in the region {}, expected AWS_REGION={} (it is {})",
                       quotable(region), quotable(region), settings.region);
  }
  if (code == "RequestTimeTooSkewed") {
    return fmt::format("the clock of this machine is {}", clock_error(answer));
  }
  if (code == "NoSuchBucket") {
    return fmt::format("there is no bucket '{}'", bucket);
  }
  if (code == "NoSuchKey") {
    return "no such object";
  }
  if (code == "InvalidAccessKeyId" || code == "InvalidToken") {
    return "the store does not know the access key";
  }
  if (code == "SignatureDoesNotMatch") {
    return "the secret key does not belong to the access key";
  }
  if (code == "ExpiredToken") {
    return "the keys have expired";
  }
  if (code == "AccessDenied" || (code.empty() && answer.status == 403)) {
    return settings.is_anonymous ? "access is denied without keys" : "access is denied";
  }
  if (code.empty()) {
    return fmt::format("{} answers {}, expected a store that speaks S3", origin, answer.status);
  }
  return fmt::format("the store says {}: {}", quotable(code), quotable(element_of(xml, "Message")));
}

ListedPage parse_listed_page(std::string_view xml) {
  ListedPage page;
  const bool is_encoded = element_of(xml, "EncodingType") == "url";
  const auto key_of = [&](std::string_view element, std::string_view name) {
    std::string key = element_of(element, name);
    if (is_encoded) {
      std::ranges::replace(key, '+', ' ');  // as in forms; a plus is %2B
      key = percent_decoded(key);
    }
    return key;
  };
  for (std::string_view rest = xml; const auto element = take_element(rest, "Contents");) {
    page.objects.push_back({.key = key_of(*element, "Key"),
                            .info = {.bytes = number_of(element_of(*element, "Size")),
                                     .etag = element_of(*element, "ETag"),
                                     .last_modified = element_of(*element, "LastModified")}});
  }
  for (std::string_view rest = xml; const auto element = take_element(rest, "CommonPrefixes");) {
    page.objects.push_back({.key = key_of(*element, "Prefix"), .is_folder = true});
  }
  std::ranges::sort(page.objects, {}, &ListedObject::key);
  page.next =
      element_of(xml, "IsTruncated") == "true" ? element_of(xml, "NextContinuationToken") : "";
  return page;
}

}  // namespace vantage
