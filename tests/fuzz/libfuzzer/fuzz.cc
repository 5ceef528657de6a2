// The program of scripts/fuzz: fuzz --target=NAME [options and folders of libFuzzer], or --list.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/target.h"

namespace {

const vantage::fuzz::Target* target = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  constexpr std::string_view kOption = "--target=";
  for (int i = 1; i < *argc; ++i) {
    const std::string_view argument = (*argv)[i];
    if (argument.starts_with(kOption)) {
      target = vantage::fuzz::find_target(argument.substr(kOption.size()));
    }
  }
  if (target == nullptr) {
    std::vector<vantage::fuzz::Target> all = vantage::fuzz::targets();
    std::ranges::sort(all, {}, &vantage::fuzz::Target::name);
    for (const auto& one : all) {
      std::printf("%s\n", std::string(one.name).c_str());
    }
    std::exit(*argc > 1 && std::string_view((*argv)[1]) == "--list" ? 0 : 2);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  vantage::fuzz::run(*target, {bytes, size});
  return 0;
}
