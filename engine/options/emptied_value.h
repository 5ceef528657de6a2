#pragma once

#include "engine/options/setting_value.h"

namespace vantage {

/// Leaves nothing in `value` for its destructor, which allocates and must not fail: of a large
/// value it would end the program where memory is refused.
inline void empty_without_memory(SettingValue& value) noexcept {
  if (auto* const object = value.get_ptr<SettingValue::object_t*>()) {
    for (auto& member : *object) {
      empty_without_memory(member.second);
    }
    object->clear();
  } else if (auto* const array = value.get_ptr<SettingValue::array_t*>()) {
    for (SettingValue& element : *array) {
      empty_without_memory(element);
    }
    array->clear();
  }
}

/// The settings of a command, which are many.
struct LargeValue {
  SettingValue value;
  ~LargeValue() { empty_without_memory(value); }
};

}  // namespace vantage
