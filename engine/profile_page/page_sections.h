#pragma once

#include <string>
#include <string_view>

#include "engine/profile_page/part_colours.h"
#include "engine/profiling/profile.h"

namespace vantage {

// The sections of a page, as HTML. Where a profile has nothing for one, it says so.

/// Command, machine, key figures, findings.
std::string overview_section(const Profile& profile);
/// Table and roofline of the stages of chains.
std::string stage_section(const Profile& profile);
/// Timeline, use of every thread, where its time went, what it waited for.
std::string thread_section(const Profile& profile, const PartColours& colours);
/// Times on every number of threads, speed-up, serial fraction.
std::string scaling_section(const Profile& profile);
std::string memory_section(const Profile& profile);
std::string counter_section(const Profile& profile);

/// Two markups beside each other where there is room.
std::string side_by_side(const std::string& left, const std::string& right);
/// `content` (markup) under a title (plain).
std::string section_markup(std::string_view title, const std::string& content);
/// A sentence (plain) as a paragraph.
std::string paragraph(std::string_view text);
/// The same for what is missing or explains.
std::string note(std::string_view text);

}  // namespace vantage
