// Object stores: what they answer, files of keys, and addresses.
#include "engine/error.h"
#include "engine/io/store/address.h"
#include "engine/io/store/aws_credentials.h"
#include "engine/io/store/store_answers.h"
#include "tests/fuzz/target.h"

namespace vantage::fuzz {
namespace {

void read_answer(Bytes bytes) {
  const std::string text = text_of(bytes);
  for (const ListedObject& object : parse_listed_page(text).objects) {
    require(object.key.size() <= text.size(), "a key of the answer");
  }
  HttpAnswer refusal{.status = 403};
  refusal.body = {bytes.begin(), bytes.end()};
  require(!reason_of(refusal, "data", "https://host", {}).empty(), "a reason");
}

void read_profiles(Bytes bytes) { (void)parse_aws_profiles(text_of(bytes)); }

void read_address(Bytes bytes) {
  const std::string text = text_of(bytes);
  const Address address = parse_address((text.starts_with("http") ? "" : "s3://") + text);
  const Address again = parse_address(address.with_key(address.key));
  require(again.place == address.place && again.key == address.key, "the same address");
}

const Registration kAnswer("store_answer", read_answer);
const Registration kProfiles("aws_profiles", read_profiles);
const Registration kAddress("address", read_address, false);

}  // namespace
}  // namespace vantage::fuzz
