#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

/// Where tests find what is not compiled into them. Environment variables say so, not macros: then
/// objects are the same in every folder, and a compiler cache can share them.
namespace vantage::test_paths {

/// What `variable` holds; throws when it is not set.
inline std::string required(const char* variable) {
  const char* path = std::getenv(variable);
  if (path == nullptr || *path == '\0') {
    throw std::runtime_error(std::string(variable) +
                             " is not set; run through ctest or scripts/test");
  }
  return path;
}

/// The program `vantage`.
inline std::string vantage_binary() { return required("VANTAGE_BINARY"); }

/// Whether that program is compiled with a sanitizer, which takes time and memory of its own: tests
/// then do less, or nothing.
inline bool is_sanitized() { return std::getenv("VANTAGE_IS_SANITIZED") != nullptr; }

/// Libraries that tests load into the program before all others.
inline std::string io_faults() { return required("PRELOAD_IO_FAULTS"); }
inline std::string clock_jump() { return required("PRELOAD_CLOCK_JUMP"); }
inline std::string allocation_count() { return required("PRELOAD_ALLOCATION_COUNT"); }

/// The folder of real photographs that lies beside some checkouts. Empty when no variable says
/// where; also what it says need not be there.
inline std::filesystem::path shared_data() {
  const char* path = std::getenv("VANTAGE_SHARED_DATA");
  return path == nullptr ? "" : path;
}

/// A folder or file of shared_data(), or an empty path when it is not there.
inline std::filesystem::path shared_data(const std::string& name) {
  const std::filesystem::path folder = shared_data();
  return !folder.empty() && std::filesystem::exists(folder / name) ? folder / name
                                                                   : std::filesystem::path();
}

}  // namespace vantage::test_paths
