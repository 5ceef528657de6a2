#include "engine/late_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <mutex>
#include <utility>

#include "engine/data_limit.h"
#include "engine/error.h"

namespace vantage {
namespace {

void* open_library(const std::string& file_name) {
  static std::mutex opening;  // the limit is that of the process
  const std::scoped_lock lock(opening);
  const UnlimitedData unlimited;
  return ::dlopen(file_name.c_str(), RTLD_NOW | RTLD_LOCAL);
}

/// Reason for the last dlfcn.h failure in this thread.
std::string last_failure() {
  const char* reason = ::dlerror();
  return reason == nullptr ? "no reason given" : reason;
}

}  // namespace

LateLibrary::LateLibrary(std::string file_name, std::string_view without_it)
    : file_name_(std::move(file_name)), without_it_(without_it), handle_(open_library(file_name_)) {
  if (handle_ == nullptr) {
    throw Error(fmt::format("{}: the library {} cannot be opened ({})", without_it_, file_name_,
                            last_failure()));
  }
}

void* LateLibrary::address(const char* name) const {
  void* found = ::dlsym(handle_, name);
  if (found == nullptr) {
    throw Error(fmt::format("{}: the library {} lacks a function ({})", without_it_, file_name_,
                            last_failure()));
  }
  return found;
}

}  // namespace vantage
