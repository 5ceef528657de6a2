#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/io/store/aws_credentials.h"
#include "engine/io/store/http_client.h"
#include "engine/io/store/object_store.h"

namespace vantage {

// What S3 answers, in XML. Only the elements that are needed are read; what is damaged or missing
// is empty. Thread rule: pure.

/// Content of the first element `name`, unescaped.
std::string element_of(std::string_view xml, std::string_view name);

/// Why the store at `origin` refuses a request for `bucket`, as the end of a message.
std::string reason_of(const HttpAnswer& answer, const std::string& bucket,
                      const std::string& origin, const AwsSettings& settings);

/// One page of ListObjectsV2 with encoding-type=url.
struct ListedPage {
  std::vector<ListedObject> objects;  ///< in the order of their keys
  std::string next;                   ///< the token of the next page; empty: the last one
};
ListedPage parse_listed_page(std::string_view xml);

}  // namespace vantage
