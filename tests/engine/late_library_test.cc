#include "engine/late_library.h"

#include "tests/engine/engine_test.h"

namespace vantage::late_library_test {

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
  EXPECT_EQ(error_of([] { const LateLibrary library("libm.so.6", "x"); }), "");
}

}  // namespace vantage::late_library_test
