#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <variant>

#include "engine/image/stereo_packing.h"
#include "tests/apps/run_fixture.h"
#include "tests/test_paths.h"

namespace vantage {

/// Runs of the program in pipes of a shell.
class StreamTest : public RunTest {
 protected:
  /// A shell command of the program.
  [[nodiscard]] static std::string command(const Words& arguments) {
    std::string line = "XDG_CONFIG_HOME=/none '" + test_paths::vantage_binary() + "' run";
    for (const std::string& word : arguments) {
      line += " '" + word + "'";
    }
    return line;
  }
  /// Exit code of the line in a shell; what the program says is in err_.
  [[nodiscard]] int shell(const std::string& line) const {
    const int status = std::system(("( " + line + " ) 2>" + err_).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  [[nodiscard]] std::string err() const { return read_file(err_); }
  /// Both images of `frames` frames side by side as raw rgb24.
  [[nodiscard]] std::string raw_pairs(int frames) const {
    std::string bytes;
    for (int frame = 0; frame < frames; ++frame) {
      Photograph packed;
      pack_stereo(read_photograph(left_ + "/" + frame_file(frame)),
                  read_photograph(right_ + "/" + frame_file(frame)), {}, packed);
      const auto& image = std::get<Image<std::uint8_t>>(packed.pixels);
      for (int y = 0; y < image.height(); ++y) {
        bytes.append(reinterpret_cast<const char*>(image.row(y)),
                     3 * static_cast<std::size_t>(image.width()));
      }
    }
    return bytes;
  }

  std::string err_ = folder_ / "err";
};

}  // namespace vantage
