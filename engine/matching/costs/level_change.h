#pragma once

#include <array>

namespace vantage {

/// What another camera would have made of a grey level: gain · level + offset, in grey levels
/// 0..255.
struct LevelChange {
  double gain = 1;
  double offset = 0;

  [[nodiscard]] bool is_none() const { return gain == 1 && offset == 0; }
  friend bool operator==(const LevelChange&, const LevelChange&) = default;
};

/// Of a photograph's luma and of its colour channels.
struct LevelChanges {
  LevelChange luma;
  std::array<LevelChange, 3> channels;

  friend bool operator==(const LevelChanges&, const LevelChanges&) = default;
};

}  // namespace vantage
