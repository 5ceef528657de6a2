#pragma once

#include <algorithm>
#include <list>
#include <string_view>
#include <utility>

#include "engine/sequence/steps/step_list.h"
#include "scheduler/processor_account.h"

namespace vantage {

/// Processor time of a run by the accounts of its steps.
class StepAccounts {
 public:
  StepAccounts() {
    for (const StepEntry& step : frame_steps()) {
      if (find(step.account) == accounts_.end()) {
        accounts_.emplace_back().name = step.account;
      }
    }
  }

  [[nodiscard]] scheduler::ProcessorAccount* of(const StepEntry& step) {
    return &find(step.account)->time;
  }

  struct Account {
    std::string_view name;
    scheduler::ProcessorAccount time;
  };
  /// In the order of the steps.
  [[nodiscard]] const std::list<Account>& all() const { return accounts_; }

 private:
  [[nodiscard]] std::list<Account>::iterator find(std::string_view name) {
    return std::ranges::find(accounts_, name, &Account::name);
  }

  std::list<Account> accounts_;
};

}  // namespace vantage
