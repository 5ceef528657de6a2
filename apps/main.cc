#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iterator>
#include <new>
#include <string>
#include <system_error>
#include <utility>

#include "apps/commands/commands.h"
#include "apps/inputs/input_limits.h"
#include "apps/process/interrupt.h"
#include "apps/process/process_setup.h"
#include "apps/process/tell.h"
#include "apps/settings/option_reference.h"
#include "apps/settings/suggestions.h"
#include "engine/build_info.h"
#include "engine/error.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/store/store_files.h"
#include "engine/message_line.h"
#include "engine/options/setting_value.h"
#include "engine/quoted_text.h"
#include "scheduler/interruption.h"

namespace {

using vantage::apps::Arguments;
using vantage::apps::Command;
using vantage::apps::commands;

constexpr const char* kSummary = "disparity maps and new views of stereo pairs and sequences";
constexpr const char* kExitCodes =
    "0 done, 1 failed, 2 wrong usage, 3 frames skipped, 130 interrupted.";

std::string help() {
  std::string text = fmt::format("Vantage: {}\n\nUsage: vantage COMMAND [OPTIONS]\n", kSummary);
  std::string_view group;
  for (const Command& command : commands()) {
    if (command.group != group) {
      group = command.group;
      text += fmt::format("\n{}\n", group);
    }
    text += fmt::format("  {:<15} {}\n", command.name, command.summary);
  }
  return text +
         fmt::format(
             "\nInputs are files, or addresses: s3://BUCKET/KEY, https://HOST/PATH.\n"
             "'vantage help COMMAND' shows the most used options of a command, 'vantage COMMAND "
             "--help-all' all.\n'vantage --version' prints the version, 'vantage --version "
             "--verbose' what a bug report needs.\nExit codes: {}\n",
             kExitCodes);
}

/// All commands, for programs; 'vantage COMMAND --help-json' has the options.
std::string help_json() {
  vantage::SettingValue list = vantage::SettingValue::array();
  for (const Command& command : commands()) {
    list.push_back({{"name", command.name}, {"title", command.summary}, {"group", command.group}});
  }
  const vantage::SettingValue document = {{"version", vantage::build_info().version},
                                          {"summary", kSummary},
                                          {"exit_codes", kExitCodes},
                                          {"commands", list},
                                          {"combinations", vantage::apps::combination_reference()}};
  return document.dump(2) + '\n';
}

/// The command at the start of the arguments, which are shortened by its words. Null if there is
/// none.
const Command* take_command(Arguments& arguments) {
  for (const Command& command : commands()) {
    const Arguments words = vantage::split(command.name, ' ');
    if (arguments.size() >= words.size() &&
        std::equal(words.begin(), words.end(), arguments.begin())) {
      arguments.erase(arguments.begin(), arguments.begin() + static_cast<long>(words.size()));
      return &command;
    }
  }
  return nullptr;
}

std::string unknown_command(const Arguments& arguments) {
  Arguments names;
  Arguments of_first_word;
  for (const Command& command : commands()) {
    names.emplace_back(command.name);
    if (command.name.starts_with(arguments.front() + ' ')) {
      of_first_word.push_back(fmt::format("'vantage {}'", command.name));
    }
  }
  if (of_first_word.size() > 1) {
    return fmt::format("'{}' is the first word of several commands, expected {}", arguments.front(),
                       fmt::join(of_first_word, " or "));
  }
  return fmt::format("unknown command '{}'{}", vantage::quotable(arguments.front()),
                     vantage::apps::hint_for_command(arguments.front(), names));
}

/// Prints the message as one line on stderr, whatever characters it has.
int fail(const std::string& command, const std::string& message, int exit_code) {
  const std::string line = fmt::format("vantage{}{}: {}\n", command.empty() ? "" : " ", command,
                                       vantage::apps::with_dashes(vantage::message_line(message)));
  vantage::apps::tell_text(line);
  return exit_code;
}

/// Addresses are opened while it lives. It ends transfers before the libraries that they use are
/// unloaded.
class AddressesInUse {
 public:
  AddressesInUse() {
    vantage::install_remote_files(vantage::make_store_files(vantage::apps::is_end_requested));
  }
  AddressesInUse(const AddressesInUse&) = delete;
  AddressesInUse& operator=(const AddressesInUse&) = delete;
  ~AddressesInUse() { vantage::install_remote_files(nullptr); }
};

/// The reader of stdout has closed it, as `head` does: not an error to report.
constexpr int kExitUnread = 128 + SIGPIPE;

int run(Arguments arguments, std::string& name) {
  if (arguments.empty()) {
    throw vantage::UsageError("a command is missing; see 'vantage --help'");
  }
  if (arguments.front() == "help") {
    Arguments asked;
    for (auto word = arguments.begin() + 1; word != arguments.end(); ++word) {
      std::ranges::move(vantage::split(*word, ' '), std::back_inserter(asked));
    }
    asked.emplace_back("--help");
    arguments = std::move(asked);
  }
  if (arguments.front() == "--help" || arguments.front() == "-h") {
    std::fputs(help().c_str(), stdout);
    return vantage::apps::kExitDone;
  }
  if (arguments.front() == "--help-json") {
    std::fputs(help_json().c_str(), stdout);
    return vantage::apps::kExitDone;
  }
  if (arguments.front() == "--version") {
    if (arguments.size() == 2 && arguments.back() == "--verbose") {
      return vantage::apps::command_info({});
    }
    if (arguments.size() > 1) {
      throw vantage::UsageError(
          fmt::format("unexpected argument '{}' after --version, expected "
                      "nothing or --verbose",
                      vantage::quotable(arguments.back())));
    }
    fmt::print("vantage {}\n", vantage::build_info().version);
    return vantage::apps::kExitDone;
  }
  const Command* command = take_command(arguments);
  if (command == nullptr) {
    throw vantage::UsageError(unknown_command(arguments));
  }
  name = command->name;
  vantage::apps::name_process(command->name);
  return command->run(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  vantage::apps::set_up_process();
  const AddressesInUse addresses;
  std::string command;
  int exit_code = vantage::apps::kExitDone;
  try {
    Arguments arguments(argv + 1, argv + argc);
    if (argc > 0 && std::filesystem::path(argv[0]).filename() == "vantage-asp") {
      arguments.insert(arguments.begin(), "asp");  // its callers name a program, not a command
    }
    exit_code = run(std::move(arguments), command);
  } catch (const vantage::UsageError& error) {
    return fail(command, error.what(), vantage::apps::kExitUsage);
  } catch (const vantage::scheduler::Interrupted&) {
    return vantage::apps::kExitInterrupted;
  } catch (const std::bad_alloc& error) {
    return fail(command, vantage::apps::memory_problem(error), vantage::apps::kExitFailed);
  } catch (const std::system_error& error) {
    return error.code() == std::errc::broken_pipe
               ? kExitUnread
               : fail(command, error.what(), vantage::apps::kExitFailed);
  } catch (const std::exception& error) {
    return fail(command, error.what(), vantage::apps::kExitFailed);
  } catch (...) {
    return fail(command, "unknown error", vantage::apps::kExitFailed);
  }
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    if (errno == EPIPE) {
      return kExitUnread;
    }
    return fail(command, "standard output cannot be written", vantage::apps::kExitFailed);
  }
  return exit_code;
}
