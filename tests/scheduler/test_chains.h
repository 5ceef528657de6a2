#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "scheduler/whole_image_pipeline.h"
#include "tests/scheduler/test_stages.h"

namespace vantage::scheduler {

class TestChain;
struct ChainCase {
  std::string name;
  std::function<void(TestChain&)> build;
};
inline std::ostream& operator<<(std::ostream& out, const ChainCase& c) { return out << c.name; }

/// A chain of stages that ends in a sink, each under supervision.
class TestChain {
 public:
  explicit TestChain(Extent source) : extent_(source) {}
  TestChain(Extent source, const ChainCase& finished) : TestChain(source) {
    finished.build(*this);
    finish();
  }

  template <typename Stage, typename... Arguments>
  void add(Arguments... arguments) {
    add(std::make_unique<Stage>(arguments...));
  }
  /// A stage that keeps the extent.
  template <typename Stage, typename... Arguments>
  void next(Arguments... arguments) {
    add(std::make_unique<Stage>(arguments..., extent_));
  }
  void add(std::unique_ptr<RowStage> stage) {
    const Extent input = stages_.empty() ? Extent{} : extent_;
    extent_ = stage->extent();
    stages_.push_back(std::move(stage));
    stages_.push_back(std::make_unique<Supervised>(*stages_.back(), input));
    chain_.push_back(stages_.back().get());
  }
  void finish() {
    auto sink = std::make_unique<Sink>(extent_);
    sink_ = sink.get();
    add(std::move(sink));
  }
  [[nodiscard]] Extent extent() const { return extent_; }
  [[nodiscard]] Chain stages() const { return chain_; }
  [[nodiscard]] int size() const { return static_cast<int>(chain_.size()); }
  [[nodiscard]] Sink& sink() const { return *sink_; }

 private:
  Extent extent_;
  std::vector<std::unique_ptr<RowStage>> stages_;
  std::vector<const RowStage*> chain_;
  Sink* sink_ = nullptr;
};

inline const ChainCase kHashed{"hashed", [](TestChain& chain) { chain.next<FloatSource>(); }};
inline const ChainCase kDiffusion{"diffusion", [](TestChain& chain) {
                                    chain.next<FloatSource>();
                                    for (int iteration = 0; iteration < 10; ++iteration) {
                                      chain.next<Diffusion>();
                                    }
                                  }};
inline const ChainCase kBoxes{"boxes", [](TestChain& chain) {
                                chain.next<FloatSource>();
                                for (const int radius : {1, 1, 1, 2}) {
                                  chain.next<Box>(radius);
                                }
                              }};
inline const ChainCase kRunning{"running", [](TestChain& chain) { chain.next<RunningSum>(2); }};
inline const ChainCase kAnchored{"anchored", [](TestChain& chain) {
                                   chain.next<FloatSource>();
                                   chain.next<AnchoredSum>(3);
                                   chain.next<Box>(1);
                                   chain.next<AnchoredSum>(1);
                                 }};
inline const ChainCase kScales{"scales", [](TestChain& chain) {
                                 const Extent full = chain.extent();
                                 chain.add<FloatSource>(full);
                                 chain.add<Box>(1, full);
                                 chain.add<Reduction>(full);
                                 const Extent half = chain.extent();
                                 chain.add<Diffusion>(half);
                                 chain.add<Reduction>(half);
                                 chain.next<AnchoredSum>(1);
                                 chain.add<Expansion>(half);
                                 chain.add<Diffusion>(half);
                                 chain.add<Expansion>(full);
                                 chain.add<Diffusion>(full);
                               }};

inline const ChainCase kSourceNext{"source_next", [](TestChain& chain) {
                                     chain.next<RunningSum>(1);
                                     chain.next<Mixture>(0, 0, true);
                                   }};
inline const ChainCase kSourceTwice{"source_twice", [](TestChain& chain) {
                                      chain.next<RunningSum>(1);
                                      chain.next<Mixture>(1, 1, false);
                                      chain.next<Mixture>(0, 2, true);
                                      chain.next<Mixture>(1, 0, false);
                                      chain.next<Mixture>(2, 3, true);
                                      chain.next<Mixture>(1, 1, false);
                                    }};
inline const ChainCase kSourceEachTime{"source_each_time", [](TestChain& chain) {
                                         chain.next<RunningSum>(2);
                                         for (int iteration = 0; iteration < 10; ++iteration) {
                                           chain.next<Mixture>(1, 1, true);
                                         }
                                       }};
inline const ChainCase kSourceAfterSmoothing{"source_after_smoothing", [](TestChain& chain) {
                                               chain.next<RunningSum>(2);
                                               chain.next<Mixture>(5, 5, false);
                                               chain.next<Mixture>(1, 1, false);
                                               for (int iteration = 0; iteration < 4; ++iteration) {
                                                 chain.next<Mixture>(1, 1, true);
                                               }
                                             }};
inline const ChainCase kSourceAnchored{"source_anchored", [](TestChain& chain) {
                                         chain.next<FloatSource>();
                                         chain.next<AnchoredSum>(3);
                                         chain.next<PullToSource>();
                                         chain.next<Diffusion>();
                                         chain.next<AnchoredSum>(1);
                                         chain.next<PullToSource>();
                                       }};

inline constexpr Extent kSizes[] = {{1, 1}, {1, 7}, {7, 1}, {13, 11}, {64, 3}, {97, 61}};

/// What the oracle makes of `chain`.
inline std::vector<std::byte> whole_image_result(const TestChain& chain) {
  chain.sink().forget();
  run_whole_image(chain.stages());
  EXPECT_TRUE(chain.sink().every_cell_came_once());
  return chain.sink().cells();
}

}  // namespace vantage::scheduler
