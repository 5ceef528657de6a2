#include "scheduler/processor_account.h"

#include "scheduler/trace.h"

namespace vantage::scheduler {
namespace {

struct ChargedThread {
  ProcessorAccount* account = nullptr;
  std::int64_t since_ns = 0;  ///< processor time of the thread when the account came into use
};
thread_local ChargedThread g_charged;

}  // namespace

ProcessorCharge::ProcessorCharge(ProcessorAccount* account) : outer_(g_charged.account) {
  change_to(account);
}

ProcessorCharge::~ProcessorCharge() { change_to(outer_); }

// The same account again, as in the tasks of a thread's own loop, costs no system call.
void ProcessorCharge::change_to(ProcessorAccount* account) {
  if (account == g_charged.account) {
    return;
  }
  const std::int64_t now_ns = thread_time_ns();
  if (g_charged.account != nullptr) {
    g_charged.account->time_ns_.fetch_add(now_ns - g_charged.since_ns, std::memory_order_relaxed);
  }
  g_charged = {account, now_ns};
}

ProcessorAccount* ProcessorCharge::account_in_use() { return g_charged.account; }

}  // namespace vantage::scheduler
