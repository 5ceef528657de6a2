#pragma once

#include <string>
#include <string_view>

#include "engine/examination/pair_examination.h"
#include "engine/options/setting_value.h"
#include "engine/sequence/pairs/pair_source.h"

namespace vantage::apps {

/// Whether rows correspond, or are corrected where a match finds how.
bool rows_correspond(const RowCheck& check);
/// A line of the table of `check`.
std::string table_line(std::string_view label, const std::string& text);
/// What was found in a pair, as lines of the table.
std::string examination_text(const FramePair& pair, const PairExamination& found);
/// What was found in a pair, as values of a report.
SettingValue examination_values(const FramePair& pair, const PairExamination& found);

}  // namespace vantage::apps
