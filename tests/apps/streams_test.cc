// Descriptors that cannot be written to, and limits of what can be.

#include <sys/wait.h>

#include <cstdlib>

#include "tests/apps/run_fixture.h"
#include "tests/test_paths.h"

namespace vantage::streams_test {

class Streams : public RunTest {
 protected:
  /// Exit code of the program with `arguments` in a shell that adds `redirection`.
  [[nodiscard]] int shell(const Words& arguments, const std::string& redirection,
                          const std::string& before = "") const {
    std::string line = before + "XDG_CONFIG_HOME=/none '" + test_paths::vantage_binary() + "'";
    for (const std::string& word : arguments) {
      line += " '" + word + "'";
    }
    const int status = std::system((line + " " + redirection).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  [[nodiscard]] Words match() const {
    return {"match", left_ + "/000000.png", right_ + "/000000.png", "-o",
            map_,    "--disparities=0:9"};
  }

  std::string out_ = folder_ / "out";
  std::string map_ = folder_ / "map.pfm";
};

TEST_F(Streams, ProgressAndRemarksNeverDecideTheOutcome) {
  const FolderContent expected = undisturbed({});
  for (const std::string redirection :
       {"2>/dev/full", "2>&-", "<&- >&- 2>&-", "2>&1 >/dev/null | true"}) {
    EXPECT_EQ(shell(arguments(out_), redirection), 0) << redirection;
    EXPECT_TRUE(same_files(results_in(out_), expected)) << redirection;
    fs::remove_all(out_);
  }
  EXPECT_EQ(shell(match(), "2>/dev/full"), 0);
  EXPECT_TRUE(fs::exists(map_));
}

TEST_F(Streams, WhatIsPrintedOnPurposeStillCounts) {
  const std::string err = folder_ / "err";
  EXPECT_EQ(shell({"info"}, ">/dev/full 2>" + err), 1);
  EXPECT_THAT(read_file(err), HasSubstr("vantage info: "));
  EXPECT_EQ(shell({"info"}, ">&- 2>" + err), 1);
  EXPECT_THAT(read_file(err), HasSubstr("vantage info: "));
  // As with other programs, whoever reads ends it by going.
  EXPECT_EQ(shell({"--help"}, "2>" + err + " | true"), 0);
  EXPECT_THAT(read_file(err), IsEmpty());
}

TEST_F(Streams, AFileThatWouldBeTooLargeIsAnError) {
  const std::string err = folder_ / "err";
  EXPECT_EQ(shell(match(), "2>" + err, "ulimit -f 4; "), 1);
  EXPECT_THAT(read_file(err), HasSubstr("map.pfm: File too large"));
  EXPECT_EQ(shell(arguments(out_), "2>" + err, "ulimit -f 4; "), 1);
  EXPECT_THAT(read_file(err), HasSubstr("File too large"));
  EXPECT_THAT(leftovers_in(folder_.path()), IsEmpty());
}

}  // namespace vantage::streams_test
