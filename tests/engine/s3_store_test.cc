#include "engine/io/store/s3_store.h"

#include "engine/error.h"
#include "tests/engine/engine_test.h"
#include "tests/engine/scripted_server.h"

namespace vantage::s3_store_test {
namespace {

std::vector<std::uint8_t> bytes_of_text(std::string_view text) {
  return {text.begin(), text.end()};
}

std::string answer(int status, const std::string& body = "", const std::string& headers = "") {
  return ScriptedServer::answer(status, body, headers);
}

/// What a store does that answers as written; without keys, which signatures have tests for.
class ScriptedStore {
 public:
  explicit ScriptedStore(std::deque<std::string> answers)
      : server(std::move(answers)),
        store("data", {.region = "", .endpoint = server.url(), .is_anonymous = true}, client_,
              credentials_) {}

  ScriptedServer server;

 private:
  HttpClient client_{[] { return false; }};
  AwsCredentials credentials_{client_};

 public:
  S3Store store;
};

const std::string kEtag = "ETag: \"1\"\r\n";

TEST(S3Store, PutsUnderConditions) {
  const std::string failed = answer(412, "<Error><Code>PreconditionFailed</Code></Error>");
  ScriptedStore s({answer(200, "", kEtag), failed, answer(409),
                   answer(404, "<Code>NoSuchKey</Code>"),
                   answer(404, "<Code>NoSuchBucket</Code>")});
  const auto put = [&](const PutCondition& condition) {
    return s.store.put("a b/k", bytes_of_text("text"), condition);
  };
  EXPECT_EQ(put({.if_absent = true}), "\"1\"");
  EXPECT_EQ(put({.if_absent = true}), std::nullopt);
  EXPECT_EQ(put({.if_absent = true}), std::nullopt);
  EXPECT_EQ(put({.if_etag = "\"2\""}), std::nullopt);
  EXPECT_THAT(error_of([&] { put({.if_absent = true}); }), HasSubstr("there is no bucket 'data'"));
  const std::vector<std::string> requests = s.server.requests();
  EXPECT_THAT(requests[0], StartsWith("PUT /data/a%20b/k HTTP/1.1"));
  EXPECT_THAT(requests[0], HasSubstr("if-none-match: *"));
  EXPECT_THAT(requests[0], HasSubstr("x-amz-checksum-crc32: O4unxw=="));  // of "text"
  EXPECT_THAT(requests[3], HasSubstr("if-match: \"2\""));
}

/// The answer to a put was lost, and the repeated one meets its own object, or another's.
TEST(S3Store, KnowsItsOwnPut) {
  for (const char* there : {"text", "else"}) {
    ScriptedStore s({"", answer(412), answer(200, "text", kEtag), answer(200, there, kEtag)});
    const auto etag = s.store.put("k", bytes_of_text("text"), {.if_absent = true});
    EXPECT_EQ(etag.has_value(), std::string_view(there) == "text");
    EXPECT_THAT(s.server.requests()[2], StartsWith("HEAD"));
  }
}

TEST(S3Store, EndsAnUploadThatFails) {
  const TemporaryFolder folder;
  put_bytes(folder / "large", std::vector<std::uint8_t>((16U << 20) + 1));
  ScriptedStore s({answer(200, "<UploadId>u/1</UploadId>"), answer(200, "", kEtag),
                   answer(400, "<Error><Code>BadDigest</Code></Error>"), answer(204)});
  EXPECT_THAT(error_of([&] { (void)s.store.put_file("k", folder / "large", {}); }),
              HasSubstr("cannot write s3://data/k: the store says BadDigest"));
  const std::vector<std::string> requests = s.server.requests();
  ASSERT_EQ(requests.size(), 4U);
  EXPECT_THAT(requests[2], StartsWith("PUT /data/k?partNumber=2&uploadId=u%2F1 "));
  EXPECT_THAT(requests[3], StartsWith("DELETE /data/k?uploadId=u%2F1 "));
}

/// Completing may fail after the state 200 has been sent.
TEST(S3Store, ReadsTheEndOfAnUpload) {
  const TemporaryFolder folder;
  put_bytes(folder / "large", std::vector<std::uint8_t>((16U << 20) + 1));
  ScriptedStore s({answer(200, "<UploadId>u</UploadId>"), answer(200, "", kEtag),
                   answer(200, "", kEtag), answer(200, "<Error><Code>InternalError</Code></Error>"),
                   answer(204)});
  EXPECT_THAT(error_of([&] { (void)s.store.put_file("k", folder / "large", {}); }),
              HasSubstr("InternalError"));
  EXPECT_THAT(s.server.requests().back(), StartsWith("DELETE"));
}

TEST(S3Store, TellsWhatIsNoStore) {
  ScriptedStore s({answer(404, "<html>Not here</html>"), answer(301, "",
                                                                "x-amz-bucket-region: "
                                                                "eu-west-1\r\n")});
  EXPECT_THAT(error_of([&] { (void)s.store.read("k", {}, "", 100); }),
              HasSubstr("answers 404, expected a store that speaks S3"));
  EXPECT_THAT(error_of([&] { (void)s.store.read("k", {}, "", 100); }),
              HasSubstr("in the region eu-west-1, expected AWS_REGION=eu-west-1"));
}

TEST(S3Store, TakesNoMoreThanWasAllowed) {
  ScriptedStore s({answer(200, std::string(101, 'x'), kEtag)});
  EXPECT_THAT(error_of([&] { (void)s.store.read("k", {}, "", 100); }),
              HasSubstr("has more than 100 bytes"));
}

}  // namespace
}  // namespace vantage::s3_store_test
