#pragma once

#include <string_view>

namespace vantage::apps {

/// Call it before anything is opened. Descriptors 0 to 2 that are closed are opened on /dev/null,
/// so that no file gets their numbers and receives what is printed; what is printed to a closed
/// stdout still fails. A write to a pipe without a reader, or beyond the limit of file sizes, then
/// fails with an error instead of ending the process with files half written. A reserve of memory
/// lets the process end in good order when there is no more.
void set_up_process();

/// The command, with which the last line of the process begins where memory ends in a destructor.
/// Static storage.
void name_process(std::string_view command);

}  // namespace vantage::apps
