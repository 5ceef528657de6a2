#include "engine/io/files/atomic_file.h"

#include "engine/io/files/temporary_name.h"
#include "tests/engine/engine_test.h"

namespace vantage::atomic_file_test {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

TEST(AtomicFileLink, IsFollowedWhereverItLeads) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "there");
  fs::create_symlink("second", folder / "first");
  fs::create_symlink(folder / "there/file", folder / "second");
  write_text_file(folder / "first", "text");  // dangling so far
  EXPECT_TRUE(fs::is_symlink(folder / "first"));
  EXPECT_EQ(bytes_of(folder / "there/file").size(), 4U);
  write_text_file(folder / "first", "longer text");
  EXPECT_EQ(bytes_of(folder / "there/file").size(), 11U);
  EXPECT_THAT(names_in(folder.path()), UnorderedElementsAre("there", "first", "second"));
  EXPECT_THAT(names_in(folder / "there"), UnorderedElementsAre("file"));

  fs::create_symlink("none/file", folder / "lost");
  EXPECT_THAT(error_of([&] { write_text_file(folder / "lost", "text"); }),
              testing::HasSubstr("there is no folder"));
  fs::create_symlink("circle", folder / "circle");
  EXPECT_EQ(through_links(folder / "circle"), folder / "circle");
}

TEST(AtomicFileName, MayBeAsLongAsFileSystemsAllow) {
  const TemporaryFolder folder;
  for (const std::string& end : {std::string(".pfm"), std::string(), "." + std::string(200, 'e')}) {
    for (const std::string letter : {"n", "\xc3\xbc"}) {
      std::string name;
      while (name.size() + letter.size() + end.size() <= 255) {
        name += letter;
      }
      name += end;
      write_text_file(folder / name, "text");
      EXPECT_EQ(bytes_of(folder / name).size(), 4U);
      const std::string temporary = temporary_name(name, 2147483647);
      EXPECT_LE(temporary.size(), 255U);
      EXPECT_TRUE(final_name_of(temporary));
      put_text(folder / temporary, "left");
      remove_temporary_files_of(folder / name);
      EXPECT_FALSE(fs::exists(folder / temporary));
    }
  }
}

TEST(TemporaryName, TellsWhatItIsOf) {
  for (const std::string name :
       {"000012.pfm", "000000-000049.mp4", "run.json", "a", ".hidden", "x.tmp-1.png", "a.b.c"}) {
    const std::string temporary = temporary_name(fs::path("folder") / name, 3);
    EXPECT_TRUE(temporary.starts_with('.')) << temporary;
    EXPECT_TRUE(temporary.ends_with(fs::path(name).extension().string())) << temporary;
    EXPECT_EQ(final_name_of(temporary), name);
  }
  for (const std::string foreign :
       {".notes.tmp-x", ".a.tmp-1-0.pfm", "a.tmp-0123abcd-1-0.pfm", ".a.tmp-0123abcd-1.pfm",
        ".a.tmp-0123abcd-1-0pfm", ".a.tmp-0123abcde-1-0", ".a.tmp-0123abcd--0",
        ".000001.pfm.swp"}) {
    EXPECT_EQ(final_name_of(foreign), std::nullopt) << foreign;
  }
}

}  // namespace vantage::atomic_file_test
