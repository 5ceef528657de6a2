#include "scheduler/control_groups.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "tests/temporary_folder.h"

namespace vantage::scheduler::control_groups_test {

constexpr std::size_t kMib = std::size_t{1} << 20;

/// A system of files, as Linux shows them.
class ControlGroups : public testing::Test {
 protected:
  ControlGroups() {
    write("proc/meminfo",
          "MemTotal:        8388608 kB\nMemFree: 1 kB\nMemAvailable:    4194304 kB\n");
  }

  void write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = folder_.path() / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  [[nodiscard]] SystemLimits read() const { return read_system_limits(folder_.path()); }

 private:
  TemporaryFolder folder_;
};

TEST_F(ControlGroups, WithoutGroupsTheSystemIsAll) {
  const SystemLimits limits = read();
  EXPECT_FALSE(limits.processors);
  EXPECT_EQ(limits.threads_of(6), 6);
  EXPECT_EQ(limits.memory_bytes, 8192 * kMib);
  EXPECT_EQ(limits.free_bytes, 4096 * kMib);
}

TEST_F(ControlGroups, OfVersionTwoTheLeastOnThePathCounts) {
  write("proc/self/cgroup", "0::/outer/inner\n");
  write("sys/fs/cgroup/cpu.max", "100000 100000\n");  // the root of a container
  write("sys/fs/cgroup/outer/cpu.max", "50000 100000\n");
  write("sys/fs/cgroup/outer/inner/cpu.max", "max 100000\n");
  write("sys/fs/cgroup/outer/memory.max", "734003200\n");
  write("sys/fs/cgroup/outer/memory.current", "209715200\n");
  write("sys/fs/cgroup/outer/memory.stat", "anon 1\ninactive_file 104857600\n");
  write("sys/fs/cgroup/outer/inner/memory.max", "max\n");
  write("sys/fs/cgroup/elsewhere/memory.max", "1\n");
  const SystemLimits limits = read();
  EXPECT_EQ(limits.processors, 0.5);
  EXPECT_EQ(limits.threads_of(6), 1);
  EXPECT_EQ(limits.memory_bytes, 700 * kMib);
  EXPECT_EQ(limits.free_bytes, 600 * kMib);
}

TEST_F(ControlGroups, OfVersionOneEachControllerHasItsOwn) {
  write("proc/self/cgroup", "5:memory:/a/b\n4:cpu,cpuacct:/a\n3:name=systemd:/x\n0::/\n");
  write("sys/fs/cgroup/cpu/a/cpu.cfs_quota_us", "250000\n");
  write("sys/fs/cgroup/cpu/a/cpu.cfs_period_us", "100000\n");
  write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "-1\n");
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  write("sys/fs/cgroup/memory/a/memory.limit_in_bytes", "524288000\n");
  write("sys/fs/cgroup/memory/a/memory.usage_in_bytes", "419430400\n");
  write("sys/fs/cgroup/memory/a/memory.stat", "inactive_file 7\ntotal_inactive_file 314572800\n");
  const SystemLimits limits = read();
  EXPECT_EQ(limits.processors, 2.5);
  EXPECT_EQ(limits.threads_of(6), 3);
  EXPECT_EQ(limits.threads_of(2), 2);
  EXPECT_EQ(limits.memory_bytes, 500 * kMib);
  EXPECT_EQ(limits.free_bytes, 400 * kMib);
}

TEST_F(ControlGroups, InAContainerThePathIsTheHosts) {
  write("proc/self/cgroup", "4:memory:/docker/0123\n2:cpu:/docker/0123\n");
  write("sys/fs/cgroup/memory/memory.limit_in_bytes", "1073741824\n");
  write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "150000\n");
  write("sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(read().threads_of(8), 2);
  EXPECT_EQ(read().memory_bytes, 1024 * kMib);
}

}  // namespace vantage::scheduler::control_groups_test
