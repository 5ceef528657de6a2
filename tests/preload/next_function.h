#pragma once

#include <dlfcn.h>

/// The function of this name that the program would call without the preloaded library.
template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}
