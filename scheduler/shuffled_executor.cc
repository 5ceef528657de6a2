#include <numeric>
#include <random>
#include <vector>

#include "scheduler/serial_executor.h"
#include "scheduler/traced_executor.h"

namespace vantage::scheduler {
namespace {

/// Finds tasks that depend on the order in which they run: every loop gets a new order.
class ShuffledExecutor final : public SerialExecutor {
 public:
  explicit ShuffledExecutor(std::uint64_t seed) : random_(seed) {}

  [[nodiscard]] std::string_view name() const override { return "shuffled"; }

  void parallel_for(int task_count, const std::function<void(int)>& body) override {
    std::vector<int> order(static_cast<std::size_t>(task_count));
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random_);
    for (int task : order) {
      body(task);
    }
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace

std::unique_ptr<Executor> make_shuffled_executor(std::uint64_t seed) {
  return with_tracing(std::make_unique<ShuffledExecutor>(seed));
}

}  // namespace vantage::scheduler
