#include "engine/io/store/http_client.h"

#define CURL_DISABLE_TYPECHECK
#include <curl/curl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <new>
#include <random>
#include <string_view>
#include <thread>
#include <utility>

#include "engine/error.h"
#include "engine/late_library.h"
#include "scheduler/interruption.h"

namespace vantage {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr int kMaxAttempts = 8;
constexpr int kMaxConnecting = 3;  // of servers that are not there
constexpr std::chrono::minutes kMaxTime{5};
constexpr milliseconds kFirstWait{100};
constexpr milliseconds kLongestWait{8000};
constexpr milliseconds kLongestAskedWait{60000};
constexpr long kConnecting_s = 10;
constexpr long kSlowBytes_per_s = 1024;
constexpr long kSlow_s = 30;

/// The functions of libcurl that are called, by the types of its header.
struct Curl {
  LateLibrary library{"libcurl.so.4", "cannot open addresses (Debian: libcurl4)"};
// NOLINTNEXTLINE(cppcoreguidelines-macro-usage)
#define VANTAGE_LATE_FUNCTION(name) \
  decltype(&::name) name = library.function<decltype(&::name)>(#name)
  VANTAGE_LATE_FUNCTION(curl_easy_cleanup);
  VANTAGE_LATE_FUNCTION(curl_easy_getinfo);
  VANTAGE_LATE_FUNCTION(curl_easy_init);
  VANTAGE_LATE_FUNCTION(curl_easy_perform);
  VANTAGE_LATE_FUNCTION(curl_easy_reset);
  VANTAGE_LATE_FUNCTION(curl_easy_setopt);
  VANTAGE_LATE_FUNCTION(curl_easy_strerror);
  VANTAGE_LATE_FUNCTION(curl_global_init);
  VANTAGE_LATE_FUNCTION(curl_slist_append);
  VANTAGE_LATE_FUNCTION(curl_slist_free_all);
#undef VANTAGE_LATE_FUNCTION
  CURLcode initialised = curl_global_init(CURL_GLOBAL_DEFAULT);
};

const Curl& curl() {
  static const Curl functions;
  return functions;
}

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
thread_local const std::atomic<bool>* cancelled_in_use = nullptr;

struct FreeHeaders {
  void operator()(curl_slist* list) const { curl().curl_slist_free_all(list); }
};

std::unique_ptr<curl_slist, FreeHeaders> list_of(const std::vector<std::string>& lines) {
  std::unique_ptr<curl_slist, FreeHeaders> list;
  for (const std::string& line : lines) {
    curl_slist* const longer = curl().curl_slist_append(list.get(), line.c_str());
    if (longer == nullptr) {
      throw std::bad_alloc();
    }
    (void)list.release();
    list.reset(longer);
  }
  return list;
}

bool is_passing(CURLcode code) {
  switch (code) {
    case CURLE_COULDNT_RESOLVE_HOST:
    case CURLE_COULDNT_CONNECT:
    case CURLE_OPERATION_TIMEDOUT:
    case CURLE_PARTIAL_FILE:
    case CURLE_GOT_NOTHING:
    case CURLE_SEND_ERROR:
    case CURLE_RECV_ERROR:
    case CURLE_SSL_CONNECT_ERROR:
      return true;
    default:
      return false;
  }
}

bool is_passing(int status) {
  return status == 429 || status == 500 || status == 502 || status == 503 || status == 504;
}

/// Full jitter: many that failed at one moment do not come back at one moment.
milliseconds wait_before(int attempt) {
  static thread_local std::minstd_rand random(std::random_device{}());
  const auto longest = std::min(kLongestWait, kFirstWait * (1 << attempt));
  return milliseconds(std::uniform_int_distribution<long>(0, longest.count())(random));
}

/// Seconds in Retry-After; its other form, a date, counts as none.
milliseconds asked_wait(const HttpAnswer& answer) {
  const std::string text = answer.header("retry-after");
  int seconds = 0;
  std::from_chars(text.data(), text.data() + text.size(), seconds);
  return std::clamp<milliseconds>(std::chrono::seconds(seconds), milliseconds(0),
                                  kLongestAskedWait);
}

}  // namespace

/// What the callbacks of one attempt know.
struct HttpClient::Transfer {
  const HttpClient& client;
  std::uint64_t max_bytes;
  HttpAnswer answer = {};
  bool is_too_long = false;
  std::exception_ptr problem = nullptr;  ///< thrown by a callback

  static std::size_t take_body(char* bytes, std::size_t, std::size_t count, void* self) {
    auto& transfer = *static_cast<Transfer*>(self);
    std::vector<std::uint8_t>& body = transfer.answer.body;
    transfer.is_too_long = count > transfer.max_bytes - body.size();
    if (transfer.is_too_long) {
      return 0;
    }
    try {
      if (body.empty()) {  // at once what it will be, so that blocks of a film take no more
        constexpr std::uint64_t kLargestReserve = 64U << 20;
        std::uint64_t length = 0;
        const std::string text = transfer.answer.header("content-length");
        std::from_chars(text.data(), text.data() + text.size(), length);
        body.reserve(std::min({length, transfer.max_bytes, kLargestReserve}));
      }
      body.insert(body.end(), bytes, bytes + count);
    } catch (...) {
      transfer.problem = std::current_exception();
      return 0;
    }
    return count;
  }

  static std::size_t take_header(char* bytes, std::size_t, std::size_t count, void* self) {
    HttpAnswer& answer = static_cast<Transfer*>(self)->answer;
    const std::string_view line(bytes, count);
    const std::size_t colon = line.find(':');
    if (line.starts_with("HTTP/")) {
      answer.headers.clear();  // of the answer that redirects here
    } else if (colon != std::string_view::npos) {
      std::string name(line.substr(0, colon));
      std::ranges::transform(name, name.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
      });
      const std::size_t begin = line.find_first_not_of(" \t", colon + 1);
      const std::size_t end = line.find_last_not_of(" \t\r\n") + 1;
      answer.headers[name] = begin < end ? line.substr(begin, end - begin) : "";
    }
    return count;
  }

  void attach_to(CURL* handle) {
    const auto set = [&](CURLoption option, auto value) {
      curl().curl_easy_setopt(handle, option, value);
    };
    void* const self = this;
    set(CURLOPT_NOPROGRESS, 0L);
    set(CURLOPT_XFERINFOFUNCTION, &Transfer::go_on);
    set(CURLOPT_XFERINFODATA, self);
    set(CURLOPT_WRITEFUNCTION, &Transfer::take_body);
    set(CURLOPT_WRITEDATA, self);
    set(CURLOPT_HEADERFUNCTION, &Transfer::take_header);
    set(CURLOPT_HEADERDATA, self);
  }

  static int go_on(void* self, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
    auto& transfer = *static_cast<Transfer*>(self);
    try {
      transfer.client.check_interruption();
    } catch (...) {
      transfer.problem = std::current_exception();
      return 1;
    }
    return 0;
  }
};

/// Handles of libcurl, each of which keeps its connection from one request to the next.
struct HttpClient::Pool {
  std::mutex mutex;
  pid_t process = ::getpid();
  std::vector<Handle> idle;
};

std::string HttpAnswer::header(const std::string& name) const {
  const auto found = headers.find(name);
  return found == headers.end() ? "" : found->second;
}

void HttpClient::FreeHandle::operator()(void* handle) const { curl().curl_easy_cleanup(handle); }

HttpClient::HttpClient(std::function<bool()> is_interrupted)
    : is_interrupted_(std::move(is_interrupted)), pool_(std::make_unique<Pool>()) {}

HttpClient::~HttpClient() = default;

HttpClient::CancelScope::CancelScope(const std::atomic<bool>& is_cancelled) {
  cancelled_in_use = &is_cancelled;
}
HttpClient::CancelScope::~CancelScope() { cancelled_in_use = nullptr; }

void HttpClient::check_interruption() const {
  if (is_interrupted_() || (cancelled_in_use != nullptr && cancelled_in_use->load())) {
    throw scheduler::Interrupted();
  }
  scheduler::check_interruption();
}

void HttpClient::wait(milliseconds time) const {
  constexpr milliseconds kStep{50};
  for (const auto end = Clock::now() + time; Clock::now() < end;) {
    check_interruption();
    std::this_thread::sleep_for(std::min<Clock::duration>(kStep, end - Clock::now()));
  }
}

HttpClient::Handle HttpClient::take_handle() {
  const std::scoped_lock lock(pool_->mutex);
  if (pool_->process != ::getpid()) {  // forked: the connections are the parent's
    for (Handle& handle : pool_->idle) {
      (void)handle.release();
    }
    pool_->idle.clear();
    pool_->process = ::getpid();
  }
  if (pool_->idle.empty()) {
    pool_->idle.emplace_back(curl().curl_easy_init());
  }
  Handle handle = std::move(pool_->idle.back());
  pool_->idle.pop_back();
  if (handle == nullptr) {
    throw std::bad_alloc();
  }
  curl().curl_easy_reset(handle.get());
  return handle;
}

int HttpClient::perform(const HttpRequest& request, Transfer& transfer, milliseconds limit) {
  Handle handle = take_handle();
  const auto set = [&](CURLoption option, auto value) {
    curl().curl_easy_setopt(handle.get(), option, value);
  };
  std::vector<std::string> lines = request.headers;
  set(CURLOPT_URL, request.url.c_str());
  set(CURLOPT_NOSIGNAL, 1L);
  set(CURLOPT_PROTOCOLS_STR, "http,https");
  set(CURLOPT_REDIR_PROTOCOLS_STR, "https");
  set(CURLOPT_HTTP_VERSION, static_cast<long>(CURL_HTTP_VERSION_1_1));
  set(CURLOPT_USERAGENT, "vantage");
  set(CURLOPT_CONNECTTIMEOUT, kConnecting_s);
  set(CURLOPT_LOW_SPEED_LIMIT, kSlowBytes_per_s);
  set(CURLOPT_LOW_SPEED_TIME, kSlow_s);
  if (const char* const file = std::getenv("AWS_CA_BUNDLE"); file != nullptr && *file != '\0') {
    set(CURLOPT_CAINFO, file);
  }
  if (limit.count() > 0) {
    set(CURLOPT_TIMEOUT_MS, static_cast<long>(limit.count()));
    set(CURLOPT_NOPROXY, "*");
  }
  if (request.follows_redirects && request.url.starts_with("https:")) {
    set(CURLOPT_FOLLOWLOCATION, 1L);
    set(CURLOPT_MAXREDIRS, 5L);
  }
  if (request.method == "HEAD") {
    set(CURLOPT_NOBODY, 1L);
  } else {
    set(CURLOPT_CUSTOMREQUEST, request.method.c_str());
  }
  if (request.method == "PUT" || request.method == "POST") {
    lines.emplace_back("Expect:");  // no waiting for a leave to send
    lines.emplace_back("Content-Type: application/octet-stream");
    const void* const body =
        request.body.empty() ? "" : static_cast<const void*>(request.body.data());
    set(CURLOPT_POSTFIELDS, static_cast<const char*>(body));
    set(CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(request.body.size()));
  }
  const std::unique_ptr<curl_slist, FreeHeaders> headers = list_of(lines);
  set(CURLOPT_HTTPHEADER, headers.get());
  transfer.attach_to(handle.get());
  const CURLcode code = curl().curl_easy_perform(handle.get());
  long status = 0;
  curl().curl_easy_getinfo(handle.get(), CURLINFO_RESPONSE_CODE, &status);
  transfer.answer.status = static_cast<int>(status);
  const std::scoped_lock lock(pool_->mutex);
  pool_->idle.push_back(std::move(handle));
  return code;
}

HttpAnswer HttpClient::send(const std::string& name, const std::function<HttpRequest()>& make) {
  const auto begin = Clock::now();
  for (int attempt = 1;; ++attempt) {
    check_interruption();
    const HttpRequest request = make();
    Transfer transfer{*this, request.max_bytes};
    const auto code = static_cast<CURLcode>(perform(request, transfer, milliseconds(0)));
    if (transfer.problem != nullptr) {
      std::rethrow_exception(transfer.problem);
    }
    if (transfer.is_too_long) {
      throw Error(
          fmt::format("cannot read {}: it has more than {} bytes", name, request.max_bytes));
    }
    transfer.answer.attempts = attempt;
    const bool has_failed = code != CURLE_OK;
    if (!(has_failed ? is_passing(code) : is_passing(transfer.answer.status))) {
      if (has_failed) {
        throw Error(fmt::format("cannot reach {}: {}", name, curl().curl_easy_strerror(code)));
      }
      return std::move(transfer.answer);
    }
    const bool is_absent = code == CURLE_COULDNT_RESOLVE_HOST || code == CURLE_COULDNT_CONNECT;
    const milliseconds pause = wait_before(attempt) + asked_wait(transfer.answer);
    if (attempt == (is_absent ? kMaxConnecting : kMaxAttempts) ||
        Clock::now() + pause - begin > kMaxTime) {
      throw Error(fmt::format("cannot reach {}: {} ({} attempts)", name,
                              has_failed
                                  ? curl().curl_easy_strerror(code)
                                  : fmt::format("its server answers {}", transfer.answer.status),
                              attempt));
    }
    wait(pause);
  }
}

HttpAnswer HttpClient::ask_service(const HttpRequest& request, milliseconds limit) {
  Transfer transfer{*this, request.max_bytes};
  const auto code = static_cast<CURLcode>(perform(request, transfer, limit));
  if (transfer.problem != nullptr) {
    std::rethrow_exception(transfer.problem);
  }
  if (code != CURLE_OK) {
    throw Error(fmt::format("cannot reach {}: {}", request.url, curl().curl_easy_strerror(code)));
  }
  return std::move(transfer.answer);
}

}  // namespace vantage
