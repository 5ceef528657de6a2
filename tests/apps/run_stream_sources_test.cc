// Runs that read named pipes and the network.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>

#include "engine/io/video/video_io.h"
#include "tests/apps/stream_fixture.h"

namespace vantage::run_stream_sources_test {

constexpr int kPairs = 4;

/// Listens on the loopback.
class Server {
 public:
  Server() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(socket_, 1), 0);
    EXPECT_EQ(::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ntohs(address.sin_port);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  ~Server() { ::close(socket_); }

  [[nodiscard]] std::string address() const { return "tcp://127.0.0.1:" + std::to_string(port_); }
  /// Whether someone connects within that time.
  [[nodiscard]] bool is_called(int ms) const {
    pollfd end{socket_, POLLIN, 0};
    return ::poll(&end, 1, ms) == 1;
  }
  /// Sends `bytes` to the first one who connects.
  void send(const std::string& bytes) const {
    if (!is_called(5000)) {
      return;
    }
    const int client = ::accept(socket_, nullptr, nullptr);
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t count = ::send(client, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) {
        break;
      }
      sent += static_cast<std::size_t>(count);
    }
    ::close(client);
  }

 private:
  int socket_;
  int port_ = 0;
};

class RunStreamSources : public StreamTest {
 protected:
  /// Frames of a side as raw rgb24.
  [[nodiscard]] static std::string raw_side(const std::string& folder) {
    std::string bytes;
    for (int frame = 0; frame < kPairs; ++frame) {
      const Photograph photograph = read_photograph(folder + "/" + frame_file(frame));
      const auto& image = std::get<Image<std::uint8_t>>(photograph.pixels);
      for (int y = 0; y < image.height(); ++y) {
        bytes.append(reinterpret_cast<const char*>(image.row(y)), 3 * std::size_t{kWidth});
      }
    }
    return bytes;
  }
  /// Packed pairs as y4m of grey with 8 bits.
  [[nodiscard]] std::string y4m() const {
    std::string bytes = "YUV4MPEG2 W" + std::to_string(2 * kWidth) + " H" +
                        std::to_string(kHeight) + " F25:1 Ip A1:1 Cmono XCOLORRANGE=FULL\n";
    const std::string raw = raw_pairs(kPairs);
    for (std::size_t i = 0; i < raw.size(); i += 3) {
      bytes += i % (raw.size() / kPairs) == 0 ? "FRAME\n" : "";
      bytes += raw[i];
    }
    return bytes;
  }
  [[nodiscard]] static Words packed(const std::string& stereo, const std::string& out,
                                    const Words& more = {}) {
    return joined({"--stereo", stereo, "--packing", "sbsl", "-o", out, "--disparities=0:9",
                   "--method", "ssd", "--quiet"},
                  more);
  }

  std::string out_ = folder_ / "out";
  std::string of_file_ = folder_ / "of_file";
};

TEST_F(RunStreamSources, OneProgramFillsTwoPipes) {
  write_file(folder_ / "l.rgb", raw_side(left_));
  write_file(folder_ / "r.rgb", raw_side(right_));
  const std::string l = folder_ / "l";
  const std::string r = folder_ / "r";
  // Opens both before it writes, and waits with each frame until both sides of the last are gone.
  write_file(folder_ / "fill.py",
             "import sys\n"
             "names, n = sys.argv[1:3], int(sys.argv[3])\n"
             "sources = [open(name + '.rgb', 'rb') for name in names]\n"
             "pipes = [open(name, 'wb', buffering=0) for name in names]\n"
             "for frame in range(4):\n"
             "  for source, pipe in zip(sources, pipes): pipe.write(source.read(n))\n");
  const Words search = words("--disparities=0:9 --method ssd --quiet");
  for (const Words& more : {Words{}, words("--every 2+1")}) {
    ASSERT_EQ(shell("mkfifo " + l + " " + r + "; python3 " + (folder_ / "fill.py") + " " + l + " " +
                    r + " " + std::to_string(3 * kWidth * kHeight) + " & " +
                    command(joined(joined({"--left", l, "--right", r, "-o", out_, "--raw-video",
                                           std::to_string(kWidth) + "x" + std::to_string(kHeight)},
                                          search),
                                   more))),
              0)
        << err();
    ASSERT_EQ(
        shell(command(joined(
            joined({"--left", left_, "--right", right_, "-o", of_file_, "--frames", "0-3"}, search),
            more))),
        0)
        << err();
    EXPECT_FALSE(results_in(out_).empty());
    EXPECT_TRUE(same_files(results_in(out_), results_in(of_file_)));
    for (const std::string& made : {l, r, out_, of_file_}) {
      fs::remove_all(made);
    }
  }
}

TEST_F(RunStreamSources, TheNetworkIsAsAFile) {
  write_file(folder_ / "pairs.y4m", y4m());
  ASSERT_EQ(shell(command(packed(folder_ / "pairs.y4m", of_file_))), 0) << err();
  const Server server;
  std::thread sender([&] { server.send(y4m()); });
  const int code = shell(command(packed(server.address(), out_)));
  sender.join();
  ASSERT_EQ(code, 0) << err();
  EXPECT_FALSE(results_in(out_).empty());
  EXPECT_TRUE(same_files(results_in(out_), results_in(of_file_)));
}

TEST_F(RunStreamSources, ContainersAreStreamed) {
  VideoWriter writer(folder_ / "pairs.mkv", 2 * kWidth, kHeight,
                     {.rate = {}, .crf = 0, .coding = VideoCoding::kFfv1_16});
  const std::string raw = raw_pairs(kPairs);
  for (std::size_t i = 0; i < raw.size();) {
    Image<std::uint16_t> grey(2 * kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < grey.width(); ++x, i += 3) {
        grey.at(x, y) = static_cast<std::uint16_t>(257 * static_cast<unsigned char>(raw[i]));
      }
    }
    writer.write(Photograph{std::move(grey)});
  }
  writer.finish();
  ASSERT_EQ(shell(command(packed(folder_ / "pairs.mkv", of_file_))), 0) << err();
  ASSERT_EQ(shell("cat " + (folder_ / "pairs.mkv") + " | " + command(packed("-", out_))), 0)
      << err();
  EXPECT_FALSE(results_in(out_).empty());
  EXPECT_TRUE(same_files(results_in(out_), results_in(of_file_)));
}

TEST_F(RunStreamSources, WhatCannotBeReachedIsOneLine) {
  std::string address;
  {
    const Server closed;
    address = closed.address();
  }
  EXPECT_EQ(shell(command(packed(address, out_))), 1);
  EXPECT_THAT(err(), HasSubstr(address + ": cannot be opened (connection refused)"));
  EXPECT_EQ(std::ranges::count(err(), '\n'), 1);
  EXPECT_FALSE(fs::exists(out_));
  const std::string pipe = folder_ / "pipe";
  ASSERT_EQ(shell("mkfifo " + pipe), 0);
  EXPECT_EQ(shell(command({"--left", pipe, "--right", right_, "-o", out_})), 2);
  EXPECT_THAT(err(), HasSubstr("left is a stream, expected one for both sides"));
  // Nobody writes: Ctrl-C ends the waiting.
  EXPECT_EQ(
      shell(command(packed(pipe, out_)) + " & pid=$!; until ls -l /proc/$pid/fd | grep -q pipe$; "
                                          "do sleep 0.02; done; kill -TERM $pid; wait $pid"),
      130)
      << err();
}

TEST_F(RunStreamSources, WhatIsReadOpensNoNetwork) {
  const Server server;
  const std::string playlist =
      "#EXTM3U\n#EXT-X-TARGETDURATION:9\n#EXTINF:9,\n" + server.address() + "/a.ts\n";
  const std::string list = "ffconcat version 1.0\nfile " + server.address() + "\n";
  for (const std::string& content : {playlist, list}) {
    for (const char* name : {"a.m3u8", "a.mp4"}) {
      write_file(folder_ / name, content);
      EXPECT_EQ(shell(command(packed(folder_ / name, out_))), 1);
    }
    EXPECT_EQ(shell("cat " + (folder_ / "a.mp4") + " | " + command(packed("-", out_))), 1);
    const Server host;
    std::thread sender([&] { host.send(content); });
    EXPECT_EQ(shell(command(packed(host.address(), out_))), 1);
    sender.join();
  }
  EXPECT_FALSE(server.is_called(0));
}

}  // namespace vantage::run_stream_sources_test
