#include "scheduler/hardware_counters.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace vantage::scheduler::hardware_counters_test {

using testing::HasSubstr;

/// Runs `script` in a shell to its end.
void run_shell(std::string script) {
  std::string shell = "sh";
  std::string option = "-c";
  const std::array<char*, 4> words = {shell.data(), option.data(), script.data(), nullptr};
  pid_t process = 0;
  ASSERT_EQ(::posix_spawn(&process, "/bin/sh", nullptr, nullptr, words.data(), environ), 0);
  int status = -1;
  ASSERT_EQ(::waitpid(process, &status, 0), process);
  ASSERT_EQ(status, 0);
}

/// The count of `name`; −1 where it is missing.
double count_of(const EventCounts& counts, std::string_view name) {
  const auto found = std::ranges::find(counts.counts, name, &EventCounts::Count::name);
  return found == counts.counts.end() ? -1 : found->events;
}

/// Whether this system counts `name` at all.
#define SKIP_WITHOUT(counts, name)                               \
  if (count_of(counts, name) < 0) {                              \
    GTEST_SKIP() << "no " << (name) << ": " << (counts).absence; \
  }

/// An opener that fails with `error`, or fails so only for what includes the kernel.
HardwareCounters::Opener refusing(int error) {
  return [error](const CountedEvent&, bool) { return -error; };
}

/// A counter that holds what was "counted", with its file in `folder`.
int made_up_counter(const std::filesystem::path& folder, std::array<std::uint64_t, 3> value) {
  const std::string path = (folder / "counter").string();
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(value.data()), sizeof value);
  return ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
}

int open_descriptors() {
  int count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    ++count;
  }
  return count;
}

TEST(HardwareCounters, CountPageFaultsOfProgramsTheProgramStarts) {
  constexpr double kBytes = 8 << 20;
  const HardwareCounters counters;
  // dd fills its one buffer of 8 MiB; the shell in between starts it as a program of its own.
  run_shell("dd if=/dev/zero of=/dev/null bs=8388608 count=1 2>/dev/null; true");
  const EventCounts counts = counters.read();
  SKIP_WITHOUT(counts, "page faults");
  const auto page_bytes = static_cast<double>(::sysconf(_SC_PAGESIZE));
  EXPECT_GE(count_of(counts, "page faults"), kBytes / page_bytes / 512) << "huge pages at most";
  EXPECT_LE(count_of(counts, "page faults"), kBytes / page_bytes + 5000);
}

TEST(HardwareCounters, CountContextSwitches) {
  const HardwareCounters counters;
  run_shell("for i in 1 2 3 4 5 6 7 8 9 10; do sleep 0.001; done");
  const EventCounts counts = counters.read();
  SKIP_WITHOUT(counts, "context switches");
  EXPECT_GE(count_of(counts, "context switches"), 10) << "each sleep is one at least";
}

TEST(HardwareCounters, DoNotCountThisProcess) {
  const HardwareCounters counters;
  std::vector<char> memory(8 << 20, 1);
  EXPECT_EQ(memory.back(), 1);
  for (const EventCounts::Count& count : counters.read().counts) {
    EXPECT_EQ(count.events, 0) << count.name;
  }
}

TEST(HardwareCounters, CountEachEventOnceOrSayWhyNot) {
  const HardwareCounters counters;
  run_shell("true");
  const EventCounts counts = counters.read();
  std::map<std::string_view, int> seen;
  for (const EventCounts::Count& count : counts.counts) {
    EXPECT_EQ(++seen[count.name], 1);
    EXPECT_THAT(counts.absence, testing::Not(HasSubstr(std::string(count.name) + ",")))
        << count.name;
  }
  for (const std::string_view name : {"cycles", "instructions", "cache misses", "page faults"}) {
    EXPECT_TRUE(seen.contains(name) || counts.absence.find(name) != std::string::npos) << name;
  }
}

TEST(HardwareCounters, ProgramsDoNotInheritTheDescriptors) {
  const TemporaryFolder folder;
  const auto descriptors_of_program = [&folder] {
    const std::string list = (folder.path() / "list").string();
    run_shell("ls /proc/self/fd > '" + list + "'");
    std::ifstream file(list);
    return std::vector<std::string>(std::istream_iterator<std::string>(file), {});
  };
  const int before = open_descriptors();
  const std::vector<std::string> without = descriptors_of_program();
  {
    const HardwareCounters counters;
    EXPECT_EQ(descriptors_of_program(), without);
  }
  EXPECT_EQ(open_descriptors(), before) << "closed at the end";
}

TEST(HardwareCounters, AbsenceIsToldOnceForEachReason) {
  struct Case {
    int error;
    std::string cause;
  };
  for (const Case& failed : {Case{ENOENT, "virtual machines"}, Case{EACCES, "perf_event_paranoid"},
                             Case{EPERM, "CAP_PERFMON"}, Case{ENOSYS, "perf_event_open"},
                             Case{EMFILE, "Too many open files"}}) {
    const EventCounts counts = HardwareCounters(refusing(failed.error)).read();
    EXPECT_TRUE(counts.counts.empty());
    EXPECT_FALSE(counts.user_mode_only);
    EXPECT_THAT(counts.absence, HasSubstr("not counted: cycles, instructions, "));
    EXPECT_THAT(counts.absence, HasSubstr("context switches"));
    EXPECT_THAT(counts.absence, HasSubstr(failed.cause));
    EXPECT_EQ(counts.absence.find(';'), std::string::npos) << "one sentence: " << counts.absence;
  }
}

TEST(HardwareCounters, CountUserModeWhereTheKernelIsNotToBeSeen) {
  const TemporaryFolder folder;
  const EventCounts counts =
      HardwareCounters([&folder](const CountedEvent&, bool with_kernel) {
        return with_kernel ? -EACCES : made_up_counter(folder.path(), {100, 7, 7});
      }).read();
  EXPECT_TRUE(counts.user_mode_only);
  EXPECT_EQ(count_of(counts, "cycles"), 100);
  EXPECT_EQ(count_of(counts, "page faults"), 100);
  EXPECT_EQ(count_of(counts, "context switches"), -1) << "they happen in the kernel";
  EXPECT_THAT(counts.absence, HasSubstr("context switches"));
}

TEST(HardwareCounters, ScaleWhatTookTurns) {
  const TemporaryFolder folder;
  const auto read = [&folder](std::array<std::uint64_t, 3> value) {
    return HardwareCounters(
               [&](const CountedEvent&, bool) { return made_up_counter(folder.path(), value); })
        .read();
  };
  EXPECT_EQ(count_of(read({100, 80, 20}), "cycles"), 400);
  EXPECT_EQ(count_of(read({100, 80, 80}), "cycles"), 100);
  EXPECT_EQ(count_of(read({0, 0, 0}), "cycles"), 0) << "no program was started";
  const EventCounts never = read({0, 80, 0});
  EXPECT_TRUE(never.counts.empty());
  EXPECT_THAT(never.absence, HasSubstr("in use"));
}

}  // namespace vantage::scheduler::hardware_counters_test
