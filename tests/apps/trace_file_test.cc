// --trace: Chrome trace events that nest and account for all threads.

#include <set>

#include "tests/apps/run_fixture.h"

namespace vantage::trace_file_test {

using nlohmann::json;

struct Slice {
  double begin_us = 0;
  double end_us = 0;
  std::string category;
};

/// Every event has what the format asks for; slices by thread, outer ones first.
std::map<int, std::vector<Slice>> checked_slices(const json& trace) {
  std::map<int, std::vector<Slice>> slices;
  std::set<int> named;
  for (const json& event : trace.at("traceEvents")) {
    EXPECT_TRUE(event.at("pid").is_number_integer());
    EXPECT_TRUE(event.at("name").is_string());
    if (event.at("ph") == "M") {
      EXPECT_TRUE(event.at("args").at("name").is_string());
      if (event.at("name") == "thread_name") {
        named.insert(event.at("tid").get<int>());
      }
      continue;
    }
    EXPECT_EQ(event.at("ph"), "X");
    EXPECT_TRUE(event.at("args").is_object());
    const double begin_us = event.at("ts");
    const double duration_us = event.at("dur");
    EXPECT_GE(begin_us, 0);
    EXPECT_GE(duration_us, 0);
    const std::string category = event.at("cat");
    EXPECT_TRUE(category == "work" || category == "join" || category == "wait") << category;
    slices[event.at("tid").get<int>()].push_back({begin_us, begin_us + duration_us, category});
  }
  for (auto& [thread, of_thread] : slices) {
    EXPECT_TRUE(named.count(thread) == 1) << thread;
    std::ranges::stable_sort(of_thread, [](const Slice& a, const Slice& b) {
      return a.begin_us != b.begin_us ? a.begin_us < b.begin_us : a.end_us > b.end_us;
    });
  }
  return slices;
}

/// Ends of slices are sums of rounded numbers.
constexpr double kRounding_us = 0.01;

/// Time of `slices` in work and waits, each moment once: in the innermost of them.
double accounted_us(const std::vector<Slice>& slices) {
  std::vector<Slice> open;
  double sum_us = 0;
  for (const Slice& slice : slices) {
    while (!open.empty() && open.back().end_us <= slice.begin_us + kRounding_us) {
      open.pop_back();
    }
    if (!open.empty()) {
      EXPECT_LE(slice.end_us, open.back().end_us + kRounding_us);
    }
    const double length_us = slice.end_us - slice.begin_us;
    if (slice.category != "join") {
      sum_us += length_us;
    }
    // What it covers of the slice around it is counted here alone.
    if (!open.empty() && open.back().category != "join") {
      sum_us -= length_us;
    }
    open.push_back(slice);
  }
  return sum_us;
}

class TraceFile : public RunTest {
 protected:
  static constexpr int kTracedFrames = 50;

  TraceFile() {
    for (int frame = kFrames; frame < kTracedFrames; ++frame) {
      for (const std::string& side : {left_, right_}) {
        fs::create_hard_link(side + "/" + frame_file(frame % kFrames),
                             side + "/" + frame_file(frame));
      }
    }
  }

  std::string trace_ = folder_ / "trace.json";
  std::string report_ = folder_ / "report.json";
};

TEST_F(TraceFile, OfARunNestsAndAccountsForAllThreads) {
  for (const std::string executor : {"tbb", "openmp", "serial"}) {
    const std::string out = folder_ / ("out-" + executor);
    succeeds(run(out, {"--save", "disparity,views", "--view", "0.5", "--threads", "2", "--executor",
                       executor, "--trace", trace_, "--report", report_}));
    const json trace = read_json(trace_);
    const double wall_us = trace.at("otherData").at("wall_us");
    EXPECT_EQ(trace.at("otherData").at("dropped_spans"), 0);
    const auto slices = checked_slices(trace);

    const json totals = read_json(report_).at("trace");
    EXPECT_EQ(totals.at("file"), trace_);
    int pool_threads = 0;
    double pool_us = 0;
    for (std::size_t t = 0; t < totals.at("threads").size(); ++t) {
      const json& thread = totals.at("threads")[t];
      const double accounted = accounted_us(slices.at(static_cast<int>(t) + 1));
      EXPECT_NEAR(
          accounted,
          1e6 * (thread.at("work_seconds").get<double>() + thread.at("wait_seconds").get<double>()),
          0.005 * wall_us);
      if (thread.at("is_in_pool").get<bool>()) {
        ++pool_threads;
        pool_us += accounted;
      }
    }
    // A thread that came too late for any task is not there.
    EXPECT_LE(pool_threads, executor == "serial" ? 1 : 2);
    EXPECT_NEAR(pool_us, pool_threads * wall_us, 0.02 * pool_threads * wall_us) << executor;
    EXPECT_EQ(totals.at("frames").size(), kTracedFrames + 1U);  // and the end
    EXPECT_GT(totals.at("stages").at("column SSD").at("seconds").get<double>(), 0);
    EXPECT_GT(totals.at("work").at("match left").at("count").get<int>(), kTracedFrames);
    double waiting_s = 0;
    for (const json& wait : totals.at("waits")) {
      waiting_s += wait.at("seconds").get<double>();
    }
    for (const json& cause_s : totals.at("waiting_for")) {
      waiting_s -= cause_s.get<double>();
    }
    EXPECT_NEAR(waiting_s, 0, 1e-6);
  }
}

TEST_F(TraceFile, MayNotBeAnotherOutputNorInAMissingFolder) {
  const std::string left = left_ + "/" + frame_file(0);
  const std::string right = right_ + "/" + frame_file(0);
  const std::string map = folder_ / "map.pfm";
  expect_failure(run_vantage({"match", left, right, "--disparities", "0:9", "-o", map, "--report",
                              report_, "--trace", report_}),
                 2, "--trace");
  expect_failure(run_vantage({"match", left, right, "--disparities", "0:9", "-o", map, "--trace",
                              folder_ / "nowhere/trace.json"}),
                 1, "nowhere");
  EXPECT_FALSE(fs::exists(map));
}

}  // namespace vantage::trace_file_test
