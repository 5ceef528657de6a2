#include "engine/late_library.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "engine/error.h"

namespace vantage {
namespace late_library_test {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// What the Error says that `use` throws.
template <typename Use>
std::string error_of(Use use) {
  try {
    use();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(LateLibrary, FindsFunctions) {
  const LateLibrary library("libm.so.6", "cannot take roots");
  EXPECT_EQ(library.function<double (*)(double)>("sqrt")(9.0), 3.0);
}

TEST(LateLibrary, OneThatIsNotThereIsNamedOnOneLine) {
  const std::string message =
      error_of([] { const LateLibrary library("libvantage-none.so.7", "cannot read videos"); });
  EXPECT_THAT(message, StartsWith("cannot read videos: the library libvantage-none.so.7 cannot"));
  EXPECT_THAT(message, HasSubstr("No such file"));
  EXPECT_THAT(message, Not(HasSubstr("\n")));
}

TEST(LateLibrary, AFunctionThatIsNotThereIsNamedOnOneLine) {
  const LateLibrary library("libm.so.6", "cannot take roots");
  const std::string message =
      error_of([&] { static_cast<void>(library.function<void (*)()>("vantage_none")); });
  EXPECT_THAT(message, StartsWith("cannot take roots: the library libm.so.6 lacks a function"));
  EXPECT_THAT(message, HasSubstr("vantage_none"));
  EXPECT_THAT(message, Not(HasSubstr("\n")));
}

TEST(LateLibrary, AnErrorDoesNotKeepTheNextAttemptFromSucceeding) {
  static_cast<void>(error_of([] { const LateLibrary missing("libvantage-none.so.7", "x"); }));
  EXPECT_EQ(error_of([] { const LateLibrary library("libm.so.6", "x"); }), "no error");
}

}  // namespace late_library_test
}  // namespace vantage
