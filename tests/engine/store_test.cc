#include "engine/error.h"
#include "engine/io/store/address.h"
#include "engine/io/store/aws_credentials.h"
#include "engine/io/store/folder_store.h"
#include "engine/io/store/signature.h"
#include "engine/io/store/store_answers.h"
#include "tests/engine/engine_test.h"

namespace vantage::store_test {
namespace {

using testing::EndsWith;

/// The request of "Examples: Signature calculations" in the API reference of Amazon S3.
std::string signature_of(const SignedParts& parts) {
  const AwsKeys keys{"AKIAIOSFODNN7EXAMPLE", "wJalrXUtnFEMI/K7MDENG/bPxRfiCYEXAMPLEKEY", ""};
  const auto time = std::chrono::system_clock::from_time_t(1369353600);  // 2013-05-24T00:00:00Z
  return signed_headers(parts, keys, "us-east-1", time).back();
}

TEST(Signature, IsThatOfTheExamplesOfAmazon) {
  SignedParts parts{.method = "GET",
                    .host = "examplebucket.s3.amazonaws.com",
                    .path = "/test.txt",
                    .query = {},
                    .headers = {{"range", "bytes=0-9"}},
                    .body = {}};
  EXPECT_THAT(
      signature_of(parts),
      EndsWith("Signature=f0e8bdb87c964420e857bd35b5d6ed310bd44f0170aba48dd91039c6036bdb41"));
  parts.path = "/";
  parts.headers = {};
  parts.query = {{"prefix", "J"}, {"max-keys", "2"}};
  EXPECT_THAT(
      signature_of(parts),
      EndsWith("Signature=34b48302e7b5fa45bde8084f4b7868a86f0a534bc59db6670ed5711ef69dc6f7"));
}

TEST(Address, NamesBucketAndKeyOrServerAndPath) {
  const auto shown = [](const std::string& text) {
    const Address address = parse_address(text);
    return address.place + " " + address.key;
  };
  EXPECT_EQ(shown("s3://data/a b/+é?#%20.png"), "data a b/+é?#%20.png");
  EXPECT_EQ(shown("s3://data/lists/../left/./1.png"), "data left/1.png");
  EXPECT_EQ(shown("s3://data"), "data ");
  EXPECT_EQ(shown("http://127.0.0.1:80/a b/%20#.png"), "http://127.0.0.1:80 a%20b/%20%23.png");
  for (const char* bad : {"s3:///key", "s3://user:word@data/key", "https://me@host/a", "s3://a:b/c",
                          "https://host/a?X-Amz-Signature=1", "https://"}) {
    EXPECT_THROW(parse_address(bad), UsageError) << bad;
  }
  try {
    parse_address("https://user:secret@host/a");
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::Not(HasSubstr("secret")));
  }
  EXPECT_EQ(percent_decoded(percent_encoded("a b/+é%&=\n", "")), "a b/+é%&=\n");
}

TEST(AwsProfiles, AreReadAsTheProgramsOfAmazonDo) {
  AwsProfiles profiles = parse_aws_profiles(
      "# keys\n[default]\naws_access_key_id = A\r\naws_secret_access_key=b/c=d\n\n"
      "[profile other]\nregion = eu-west-1\ns3 =\n  endpoint_url = x\nwithout equals\n[broken\n");
  EXPECT_EQ(profiles["default"]["aws_access_key_id"], "A");
  EXPECT_EQ(profiles["default"]["aws_secret_access_key"], "b/c=d");
  EXPECT_EQ(profiles["other"]["region"], "eu-west-1");
  EXPECT_FALSE(profiles["other"].contains("endpoint_url"));
}

TEST(StoreAnswers, GiveKeysAndReasons) {
  const ListedPage page = parse_listed_page(
      "<ListBucketResult><EncodingType>url</EncodingType><IsTruncated>true</IsTruncated>"
      "<NextContinuationToken>a&amp;b</NextContinuationToken><CommonPrefixes><Prefix>b/</Prefix>"
      "</CommonPrefixes><Contents><Key>a+b%2B%C3%A9</Key><Size>12</Size><ETag>&quot;e&quot;</ETag>"
      "</Contents><Contents><Key>cut");
  ASSERT_EQ(page.objects.size(), 2U);
  EXPECT_EQ(page.objects[0].key, "a b+é");
  EXPECT_EQ(page.objects[0].info.bytes, 12U);
  EXPECT_EQ(page.objects[0].info.etag, "\"e\"");
  EXPECT_TRUE(page.objects[1].is_folder);
  EXPECT_EQ(page.next, "a&b");
  HttpAnswer refusal{.status = 400};
  const auto reason = [&](std::string_view xml) {
    refusal.body = {xml.begin(), xml.end()};
    return reason_of(refusal, "data", "https://host", {.region = "us-east-1"});
  };
  EXPECT_EQ(reason("<Error><Code>NoSuchKey</Code><Region>x"), "no such object");
  EXPECT_THAT(reason("<Region>eu-west-1</Region>"), HasSubstr("expected AWS_REGION=eu-west-1"));
  EXPECT_EQ(reason("<Code>A</Code><Message>b &lt;c&gt;\n</Message>"), "the store says A: b <c>\\n");
}

std::vector<std::uint8_t> bytes_of_text(std::string_view text) {
  return {text.begin(), text.end()};
}

TEST(FolderStore, PutsUnderConditions) {
  const TemporaryFolder folder;
  FolderStore store(folder.path());
  const auto put = [&](std::string_view text, const PutCondition& condition) {
    return store.put("claims/a", bytes_of_text(text), condition);
  };
  EXPECT_FALSE(put("x", {.if_etag = "none"}).has_value());
  const auto first = put("one", {.if_absent = true});
  ASSERT_TRUE(first.has_value());
  EXPECT_FALSE(put("two", {.if_absent = true}).has_value());
  const auto second = put("three", {.if_etag = *first});
  ASSERT_TRUE(second.has_value());
  EXPECT_FALSE(put("four", {.if_etag = *first}).has_value());
  EXPECT_EQ(store.read("claims/a", {}, *second, 10).bytes, bytes_of_text("three"));
  EXPECT_EQ(store.read("claims/a", ByteRange{1, 3}, "", 10).bytes, bytes_of_text("hre"));
  EXPECT_THROW(store.read("claims/a", {}, *first, 10), Error);
  EXPECT_THROW(store.read("claims/a", {}, "", 4), Error);

  // Of many at once, one takes what is there.
  std::atomic<int> taken = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 8; ++i) {
      threads.emplace_back(
          [&, i] { taken += put(std::to_string(i), {.if_etag = *second}).has_value() ? 1 : 0; });
    }
  }
  EXPECT_EQ(taken, 1);
  (void)store.put("b", bytes_of_text("b"), {});
  const auto listed = [&](const std::string& prefix, bool one_level) {
    std::string names;
    store.list(prefix, one_level, [&](const ListedObject& object) {
      names += object.key + ' ';
      return true;
    });
    return names;
  };
  EXPECT_EQ(listed("", true), "b claims/ ");
  EXPECT_EQ(listed("", false), "b claims/a ");
  EXPECT_EQ(listed("claims/", true), "claims/a ");
  store.remove("b");
  store.remove("b");
  EXPECT_FALSE(store.info("b").has_value());
}

}  // namespace
}  // namespace vantage::store_test
