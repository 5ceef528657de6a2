#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace vantage {

/// A server on 127.0.0.1 that answers request after request with what a test has written, whatever
/// it was asked, each on a connection of its own. An empty answer: it hangs up.
class ScriptedServer {
 public:
  explicit ScriptedServer(std::deque<std::string> answers) : answers_(std::move(answers)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    if (::bind(listener_, any, size) != 0 || ::listen(listener_, 8) != 0 ||
        ::getsockname(listener_, any, &size) != 0) {
      std::abort();
    }
    url_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this] { serve(); });
  }
  ScriptedServer(const ScriptedServer&) = delete;
  ScriptedServer& operator=(const ScriptedServer&) = delete;
  ~ScriptedServer() {
    ::shutdown(listener_, SHUT_RDWR);  // accept() returns
    thread_.join();
    ::close(listener_);
  }

  [[nodiscard]] const std::string& url() const { return url_; }
  /// Method, path and headers of the requests so far.
  [[nodiscard]] std::vector<std::string> requests() {
    const std::scoped_lock lock(mutex_);
    return requests_;
  }

  /// An answer of the state `status` with this body and further header lines ("A: b\r\n").
  static std::string answer(int status, const std::string& body, const std::string& headers = "") {
    return "HTTP/1.1 " + std::to_string(status) + " state\r\nConnection: close\r\n" + headers +
           "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
  }

 private:
  void serve() {
    for (int client = ::accept(listener_, nullptr, nullptr); client >= 0;
         client = ::accept(listener_, nullptr, nullptr)) {
      std::string text;
      std::size_t end = std::string::npos;
      std::size_t body = 0;
      for (char block[4096]; end == std::string::npos || text.size() < end + 4 + body;) {
        const ssize_t count = ::recv(client, block, sizeof(block), 0);
        if (count <= 0) {
          break;
        }
        text.append(block, static_cast<std::size_t>(count));
        end = text.find("\r\n\r\n");
        const std::size_t length = text.find("Content-Length: ");
        body = length < end ? std::strtoul(text.c_str() + length + 16, nullptr, 10) : 0;
      }
      const std::scoped_lock lock(mutex_);
      requests_.push_back(text.substr(0, end));
      const std::string reply = answers_.empty() ? "" : answers_.front();
      if (!answers_.empty()) {
        answers_.pop_front();
      }
      (void)::send(client, reply.data(), reply.size(), MSG_NOSIGNAL);
      ::close(client);
    }
  }

  int listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  std::string url_;
  std::mutex mutex_;
  std::deque<std::string> answers_;
  std::vector<std::string> requests_;
  std::thread thread_;
};

}  // namespace vantage
