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

/// A chain of stages that ends in a sink, each under supervision.
class TestChain {
 public:
  explicit TestChain(Extent source) : extent_(source) {}

  template <typename Stage, typename... Arguments>
  void add(Arguments... arguments) {
    add(std::make_unique<Stage>(arguments...));
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

struct ChainCase {
  std::string name;
  std::function<void(TestChain&)> build;
};
inline std::ostream& operator<<(std::ostream& out, const ChainCase& c) { return out << c.name; }

inline const ChainCase kHashed{"hashed",
                               [](TestChain& chain) { chain.add<FloatSource>(chain.extent()); }};
inline const ChainCase kDiffusion{"diffusion", [](TestChain& chain) {
                                    chain.add<FloatSource>(chain.extent());
                                    for (int iteration = 0; iteration < 10; ++iteration) {
                                      chain.add<Diffusion>(chain.extent());
                                    }
                                  }};
inline const ChainCase kBoxes{"boxes", [](TestChain& chain) {
                                chain.add<FloatSource>(chain.extent());
                                for (const int radius : {1, 1, 1, 2}) {
                                  chain.add<Box>(radius, chain.extent());
                                }
                              }};
inline const ChainCase kRunning{"running",
                                [](TestChain& chain) { chain.add<RunningSum>(2, chain.extent()); }};
inline const ChainCase kAnchored{"anchored", [](TestChain& chain) {
                                   chain.add<FloatSource>(chain.extent());
                                   chain.add<AnchoredSum>(3, chain.extent());
                                   chain.add<Box>(1, chain.extent());
                                   chain.add<AnchoredSum>(1, chain.extent());
                                 }};
inline const ChainCase kScales{"scales", [](TestChain& chain) {
                                 const Extent full = chain.extent();
                                 chain.add<FloatSource>(full);
                                 chain.add<Box>(1, full);
                                 chain.add<Reduction>(full);
                                 const Extent half = chain.extent();
                                 chain.add<Diffusion>(half);
                                 chain.add<Reduction>(half);
                                 chain.add<AnchoredSum>(1, chain.extent());
                                 chain.add<Expansion>(half);
                                 chain.add<Diffusion>(half);
                                 chain.add<Expansion>(full);
                                 chain.add<Diffusion>(full);
                               }};

inline const ChainCase kSourceNext{"source_next", [](TestChain& chain) {
                                     const Extent extent = chain.extent();
                                     chain.add<RunningSum>(1, extent);
                                     chain.add<Mixture>(0, 0, true, extent);
                                   }};
inline const ChainCase kSourceTwice{"source_twice", [](TestChain& chain) {
                                      const Extent extent = chain.extent();
                                      chain.add<RunningSum>(1, extent);
                                      chain.add<Mixture>(1, 1, false, extent);
                                      chain.add<Mixture>(0, 2, true, extent);
                                      chain.add<Mixture>(1, 0, false, extent);
                                      chain.add<Mixture>(2, 3, true, extent);
                                      chain.add<Mixture>(1, 1, false, extent);
                                    }};
inline const ChainCase kSourceEachTime{"source_each_time", [](TestChain& chain) {
                                         const Extent extent = chain.extent();
                                         chain.add<RunningSum>(2, extent);
                                         for (int iteration = 0; iteration < 10; ++iteration) {
                                           chain.add<Mixture>(1, 1, true, extent);
                                         }
                                       }};
inline const ChainCase kSourceAfterSmoothing{"source_after_smoothing", [](TestChain& chain) {
                                               const Extent extent = chain.extent();
                                               chain.add<RunningSum>(2, extent);
                                               chain.add<Mixture>(5, 5, false, extent);
                                               chain.add<Mixture>(1, 1, false, extent);
                                               for (int iteration = 0; iteration < 4; ++iteration) {
                                                 chain.add<Mixture>(1, 1, true, extent);
                                               }
                                             }};
inline const ChainCase kSourceAnchored{"source_anchored", [](TestChain& chain) {
                                         const Extent extent = chain.extent();
                                         chain.add<FloatSource>(extent);
                                         chain.add<AnchoredSum>(3, extent);
                                         chain.add<PullToSource>(extent);
                                         chain.add<Diffusion>(extent);
                                         chain.add<AnchoredSum>(1, extent);
                                         chain.add<PullToSource>(extent);
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
