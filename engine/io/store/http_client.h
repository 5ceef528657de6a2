#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace vantage {

struct HttpRequest {
  std::string method = "GET";
  std::string url;
  std::vector<std::string> headers = {};    ///< "name: value"
  std::span<const std::uint8_t> body = {};  ///< of PUT and POST
  std::uint64_t max_bytes = 1U << 20;       ///< of the answer; more is an error
  bool follows_redirects = false;           ///< from https to https only
};

struct HttpAnswer {
  int status = 0;
  std::map<std::string, std::string> headers = {};  ///< names in lower case
  std::vector<std::uint8_t> body = {};
  int attempts = 1;

  /// Empty where there is none.
  [[nodiscard]] std::string header(const std::string& name) const;
  [[nodiscard]] std::string text() const { return {body.begin(), body.end()}; }
};

/// Sends requests with libcurl, which is opened by the first one. Connections are kept. Thread
/// rule: may be used concurrently.
class HttpClient {
 public:
  /// `is_interrupted` is asked while transfers run; it may be called by any thread.
  explicit HttpClient(std::function<bool()> is_interrupted);
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;
  ~HttpClient();

  /// The answer, whatever its status. Repeats the request, which `make` makes anew each time, after
  /// growing random waits: where nothing or not all arrives, and for the states 429, 500, 502, 503
  /// and 504, whose Retry-After counts. Throws Error "cannot read NAME: ..." after 8 attempts or 5
  /// minutes; scheduler::Interrupted.
  HttpAnswer send(const std::string& name, const std::function<HttpRequest()>& make);
  /// One attempt, within `limit`, past any proxy: of a service of this machine. Throws Error.
  HttpAnswer ask_service(const HttpRequest& request, std::chrono::milliseconds limit);

  /// Throws scheduler::Interrupted if the process, the scope of this thread, or its CancelScope is.
  void check_interruption() const;

  /// While it lives, transfers of its thread end with Interrupted once `is_cancelled`.
  class CancelScope {
   public:
    explicit CancelScope(const std::atomic<bool>& is_cancelled);
    CancelScope(const CancelScope&) = delete;
    CancelScope& operator=(const CancelScope&) = delete;
    ~CancelScope();
  };

 private:
  struct FreeHandle {
    void operator()(void* handle) const;
  };
  using Handle = std::unique_ptr<void, FreeHandle>;
  struct Transfer;
  Handle take_handle();
  void wait(std::chrono::milliseconds time) const;
  /// Performs it once; the code of libcurl.
  int perform(const HttpRequest& request, Transfer& transfer, std::chrono::milliseconds limit);

  std::function<bool()> is_interrupted_;
  struct Pool;
  std::unique_ptr<Pool> pool_;
};

}  // namespace vantage
