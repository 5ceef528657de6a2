#include "tests/engine/made_up_profiles.h"
#include "tests/engine/engine_test.h"

#include <fmt/format.h>

namespace vantage {
namespace {

ProfileSample around(double median, double spread = 0.03) {
  return {median, median * (1 - spread), median * (1 + spread)};
}

Profile machine(std::vector<int> thread_counts) {
  Profile profile;
  profile.version = "0.1.0";
  profile.date = "2026-03-09T11:45:10Z";
  profile.processor = "Example Processor 9000 at 3.10 GHz";
  profile.isa = "AVX3";
  profile.hardware_threads = thread_counts.back();
  for (const int threads : thread_counts) {
    profile.ceilings.push_back({.threads = threads,
                                .core_gflops = 120,
                                .all_gflops = 118.0 * threads,
                                .core_l2_gb_per_s = 140,
                                .all_l2_gb_per_s = 136.0 * threads,
                                .core_memory_gb_per_s = 12,
                                .all_memory_gb_per_s = 12 * std::pow(threads, 0.7)});
  }
  return profile;
}

// A stage on `cells` cells of 64 candidates each column.
StageProfile stage(std::string name, double seconds, double cells, double operations_per_cell,
                   double bytes_per_cell, double halo) {
  return {.name = std::move(name),
          .seconds = around(seconds),
          .columns = cells / 64,
          .own_columns = cells / 64 / (1 + halo),
          .cells = cells,
          .operations = cells * operations_per_cell,
          .bytes = cells * bytes_per_cell};
}

void add_speed_ups(double serial, Profile& profile) {
  for (const ThreadCountProfile& count : profile.thread_counts) {
    SpeedUp speed_up;
    speed_up.threads = count.threads;
    const double ratio = profile.thread_counts.front().wall_s.median / count.wall_s.median;
    speed_up.ratio = around(ratio, count.threads == 1 ? 0 : 0.04);
    speed_up.efficiency = ratio / count.threads;
    if (count.threads > 1) {
      speed_up.serial_fraction = (1 / ratio - 1.0 / count.threads) / (1 - 1.0 / count.threads);
    }
    profile.speed_ups.push_back(speed_up);
  }
  profile.serial_fraction = serial;
}

ThreadCountProfile match_on(int threads) {
  ThreadCountProfile count;
  count.threads = threads;
  count.runs = 5;
  const double parallel_s = 0.52 / threads;
  count.wall_s = around(0.06 + parallel_s);
  count.compute_s = around(0.02 + parallel_s);
  count.cells_per_s = around(2 * 7680000 / (0.02 + parallel_s));
  const double pool_s = (0.06 + parallel_s) * threads;
  count.work_share = around(0.56 / pool_s, 0.01);
  count.imbalance = around(threads == 1 ? 1 : 1.04, 0.01);
  count.stages = {stage("Bayes iteration", 0.402, 164e6, 11, 12, 0.0675),
                  stage("cost", 0.071, 17.7e6, 34, 5, 0.15),
                  stage("Bayes start", 0.023, 17.7e6, 3, 8, 0.15),
                  stage("cell selection", 0.0052, 15.4e6, 1.2, 4.1, 0)};
  count.parts = {{"match left", around(0.268), 24}, {"match right", around(0.251), 24},
                 {"write", around(0.0167), 1},      {"read", around(0.0031), 2},
                 {"prepare", around(0.0047), 39},   {"cross-check", around(0.0005), 20},
                 {"fill", around(0.00014), 39}};
  const double waited_s = pool_s - 0.56;
  count.waits = {{"idle", around(0.9 * waited_s), 35},
                 {"wait for tasks", around(0.1 * waited_s), 84}};
  count.waiting_for = {.reading_s = around(0.003),
                       .computing_s = around(0.1 * waited_s),
                       .writing_s = around(0.016),
                       .nothing_s = around(0.7 * waited_s)};
  for (int i = 0; i < threads; ++i) {
    const double work_s = 0.56 / threads * (i == 0 ? 1.04 : 0.96);
    count.workers.push_back(
        {i == 0 ? "main" : fmt::format("worker {}", i), true, work_s, pool_s / threads - work_s});
  }
  return count;
}

ThreadCountProfile run_on(int threads) {
  ThreadCountProfile count;
  count.threads = threads;
  count.runs = 3;
  const double work_s = 200 * 0.61;
  const double wall_s = work_s * (0.012 + 0.988 / threads);
  count.wall_s = around(wall_s);
  count.compute_s = around(wall_s * 0.97);
  count.cells_per_s = around(200 * 2 * 265e6 / wall_s);
  count.frames_per_s = around(200 / wall_s);
  count.work_share = around(work_s / (wall_s * threads), 0.01);
  count.imbalance = around(1 + 0.01 * threads, 0.01);
  count.stages = {stage("column SSD", 41, 106e9, 3, 2.2, 0.04),
                  stage("window selection", 58, 106e9, 5, 0.9, 0)};
  count.parts = {{"match left", around(51), 12800},   {"match right", around(50), 12800},
                 {"synthesise", around(9.5), 13000},  {"encode frame", around(6.1), 200},
                 {"read frame", around(2.2), 201},    {"fill", around(1.6), 13000},
                 {"cross-check", around(1.2), 13000}, {"speckles", around(0.9), 200},
                 {"prepare", around(0.4), 13000}};
  const double waited_s = wall_s * threads - work_s;
  count.waits = {{"idle", around(0.6 * waited_s), 4100},
                 {"wait for tasks", around(0.4 * waited_s), 60000},
                 {"disk", around(0.02), 12}};
  count.waiting_for = {.reading_s = around(0.5 * waited_s),
                       .computing_s = around(0.3 * waited_s),
                       .writing_s = around(0.15 * waited_s),
                       .nothing_s = around(0.05 * waited_s)};
  for (int i = 0; i < threads; ++i) {
    const double own_s = work_s / threads * (i == 3 ? 1.16 : 0.98 + 0.003 * i);
    count.workers.push_back({i == 0 ? "main" : fmt::format("worker {}", i), true, own_s,
                             std::max(0.0, wall_s - own_s)});
  }
  count.workers.push_back({"deliveries", false, 0.8, wall_s - 0.8});
  return count;
}

}  // namespace

Profile made_up_match() {
  Profile profile = machine({1, 2});
  profile.command = "vantage match left.png right.png -o disparity.pfm --method bayes";
  profile.thread_counts = {match_on(1), match_on(2)};
  add_speed_ups(0.09, profile);
  profile.peak_memory_bytes = 81'698'816;
  profile.timeline_s = profile.thread_counts.back().wall_s.median;
  for (int thread = 0; thread < 2; ++thread) {
    TimelineRow row{thread == 0 ? "main" : "worker 1", true, {}};
    double now_s = 0;
    const auto add = [&](const std::string& name, bool is_wait, double duration_s) {
      row.spans.push_back({name, is_wait, now_s, now_s + duration_s});
      now_s += duration_s;
    };
    add("idle", true, 0.004);
    if (thread == 0) {
      add("read", false, 0.003);
    } else {
      add("idle", true, 0.003);
    }
    add("prepare", false, 0.0025);
    add("match left", false, 0.139 + 0.002 * thread);
    add("wait for tasks", true, 0.004 - 0.002 * thread);
    add("match right", false, 0.128 - 0.003 * thread);
    add("wait for tasks", true, 0.0015 + 0.003 * thread);
    add("cross-check", false, 0.0004);
    if (thread == 0) {
      add("write", false, 0.0167);
    }
    add("idle", true, profile.timeline_s - now_s);
    profile.timeline.push_back(row);
  }
  profile.memory = {{"rows between stages", 21'200'000},
                    {"images and maps", 12'900'000},
                    {"states between passes", 9'000'000}};
  return profile;
}

Profile made_up_run() {
  Profile profile = machine({1, 2, 4, 8, 16});
  profile.command =
      "vantage run --left left.mp4 --right right.mp4 -o views --save disparity,views --view 0.5";
  for (const int threads : {1, 2, 4, 8, 16}) {
    profile.thread_counts.push_back(run_on(threads));
  }
  add_speed_ups(0.012, profile);
  profile.peak_memory_bytes = 1'410'000'000;
  profile.timeline_s = profile.thread_counts.back().wall_s.median;
  std::mt19937 random(7);
  const std::vector<std::string> parts = {"match left", "match right", "cross-check", "fill",
                                          "speckles",   "synthesise",  "encode frame"};
  for (int thread = 0; thread < 16; ++thread) {
    TimelineRow row{thread == 0 ? "main" : fmt::format("worker {}", thread), true, {}};
    double now_s = 0;
    for (int step = 0; now_s < profile.timeline_s - 0.2; ++step) {
      const int frame = static_cast<int>(now_s / profile.timeline_s * 200) + thread % 3;
      const bool is_wait = random() % 9 == 0;
      const double duration_s =
          (is_wait ? 0.01 : 0.05) + static_cast<double>(random() % 100) * 0.001;
      const std::string& part =
          parts[(static_cast<std::size_t>(step) + random() % 2) % parts.size()];
      row.spans.push_back({is_wait ? "wait for tasks" : part, is_wait, now_s, now_s + duration_s,
                           std::min(frame, 199)});
      now_s += duration_s;
    }
    row.spans.push_back({"idle", true, now_s, profile.timeline_s});
    profile.timeline.push_back(row);
  }
  profile.timeline.push_back({"deliveries", false, {{"deliver", false, 1.5, 1.7, 20}}});
  profile.memory = {{"frames in flight", 820'000'000},
                    {"rows between stages", 310'000'000},
                    {"encoders", 96'000'000}};
  return profile;
}

}  // namespace vantage
