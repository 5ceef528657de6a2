#include "engine/sequence/journal/pending_files.h"

#include "tests/engine/engine_test.h"

namespace vantage::pending_files_test {

namespace fs = std::filesystem;

using Bytes = std::vector<std::uint8_t>;

/// Names below `folder`, hidden ones too.
std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

class PendingFilesTest : public testing::Test {
 protected:
  [[nodiscard]] fs::path path(const std::string& name) const { return fs::path(folder_ / name); }

  TemporaryFolder folder_;
  std::set<fs::path> changed_;
};

TEST_F(PendingFilesTest, AppearWhenTheyAreCommitted) {
  PendingFiles files;
  for (int i = 0; i < 7; ++i) {
    files.add(path(std::to_string(i)), Bytes(static_cast<std::size_t>(i) * 1000, 5));
  }
  for (const std::string& name : names_in(path("."))) {
    EXPECT_TRUE(name.starts_with('.')) << name;
  }
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < 5; ++i) {  // the last two are left to commit()
      threads.emplace_back([&files, i] { files.flush(i); });
    }
  }
  EXPECT_EQ(files.count(), 7U);
  files.commit(changed_);
  EXPECT_THAT(names_in(path(".")), ElementsAre("0", "1", "2", "3", "4", "5", "6"));
  EXPECT_EQ(bytes_of(path("6")), Bytes(6000, 5));
  EXPECT_EQ(changed_.size(), 1U);
  EXPECT_EQ(files.count(), 0U);
}

TEST_F(PendingFilesTest, WhatCannotBeFlushedGetsNoName) {
  for (const bool flush_before : {true, false}) {
    PendingFiles files;
    files.add(path("a"), Bytes(10, 1));
    const std::set<std::string> first = names_in(path("."));
    files.add(path("b"), Bytes(10, 2));
    files.add(path("c"), Bytes(10, 3));
    for (const std::string& name : names_in(path("."))) {
      if (!first.contains(name) && name.find("b") != std::string::npos) {
        fs::remove(path(name));
      }
    }
    for (std::size_t i = 0; flush_before && i < files.count(); ++i) {
      files.flush(i);
    }
    EXPECT_THAT(error_of([&] { files.commit(changed_); }), HasSubstr(path("b").string()));
    EXPECT_THROW(files.commit(changed_), OutputError);
    files.discard();
    EXPECT_THAT(names_in(path(".")), ElementsAre("a"));
    fs::remove(path("a"));
  }
}

TEST_F(PendingFilesTest, LeaveNothingWhenTheyAreGivenUp) {
  {
    PendingFiles files;
    files.add(path("a"), Bytes(10, 1));
    files.flush(0);
  }
  EXPECT_TRUE(names_in(path(".")).empty());
  PendingFiles files;
  EXPECT_THAT(error_of([&] { files.add(path("none/a"), Bytes(1)); }),
              HasSubstr(path("none/a").string()));
}

}  // namespace vantage::pending_files_test
