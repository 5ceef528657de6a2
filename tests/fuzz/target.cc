#include "tests/fuzz/target.h"

#include <algorithm>
#include <exception>
#include <fstream>
#include <stdexcept>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "tests/temporary_folder.h"

namespace vantage::fuzz {

std::vector<Target>& targets() {
  static std::vector<Target> all;
  return all;
}

const Target* find_target(std::string_view name) {
  const auto found = std::ranges::find(targets(), name, &Target::name);
  return found == targets().end() ? nullptr : &*found;
}

void require(bool holds, const char* what) {
  if (!holds) {
    throw std::logic_error(what);
  }
}

void run(const Target& target, Bytes bytes) {
  // A picture may be large because it says so, and that takes the time and memory of its pixels.
  set_max_image_pixels(1 << 20);
  try {
    target.take(bytes);
  } catch (const Error& error) {
    const std::string message = error.what();
    require(!message.empty() && message.find('\n') == std::string::npos, "a message of one line");
    if (target.names_input && message.find("input") == std::string::npos) {
      throw std::logic_error("names no file: " + message);
    }
  }
}

std::filesystem::path file_of(Bytes bytes, const std::string& name) {
  static const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / name;
  // A file that replaces another one's content waits for the disk; a new one does not.
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  return path;
}

std::pair<Bytes, Bytes> halves_of(Bytes bytes) {
  const auto zero = std::ranges::find(bytes, 0);
  const auto size = static_cast<std::size_t>(zero - bytes.begin());
  return {bytes.first(size), bytes.subspan(std::min(size + 1, bytes.size()))};
}

}  // namespace vantage::fuzz
