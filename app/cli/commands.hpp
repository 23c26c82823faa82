#pragma once

#include "app/cli/arguments.hpp"
#include "app/cli/console.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Command of the program. The same table of commands feeds the parser, the help and the tests.
struct Command {
    std::string_view name;
    std::string_view summary; ///< one line, for the list of commands
    std::string_view about;   ///< purpose and results
    std::string_view example; ///< working command lines, with their purpose
    std::span<const Operand> operands;
    std::span<const Option> options;
    void (*run)(const Arguments&, const Console&);
    bool runs_until_stopped = false; ///< INT and TERM are its ordinary end: exit status 0
};

/// Returns all commands, in the order of a typical workflow.
std::span<const Command> commands();

/// Returns the command of that name; null if there is none.
const Command* command_named(std::string_view name);

/// Returns "unknown command 'imprt'; did you mean import?"
std::string refusal_of_command(std::string_view name);

/// Returns the usage line: "macadam iri PROFILE [OPTION...]".
std::string usage_of(const Command& command);

/// Returns the options of a command: those of its table, then those common to all commands.
std::vector<Option> options_of(const Command& command);

/// Options of a command under one heading of its help, in the order of the table.
struct OptionGroup {
    std::string_view title;
    std::vector<Option> options;
};

/// Returns the options of a command by group, in the order in which groups first appear in its
/// table; "options", which all commands have, comes first and ends with the common ones.
std::vector<OptionGroup> option_groups_of(const Command& command);

/// Returns "-o --output FILE", "--trip TRIP...": an option as help shows it.
std::string term_of(const Option& option);

/// Returns the output of `macadam COMMAND --help`, or of --help-all with the rare options.
enum class HelpDetail { usual, all };
std::string help_of(const Command& command, HelpDetail detail = HelpDetail::usual);

/// Returns the output of `macadam --help`, for this stream.
std::string help_of_all(int stream);

/// Parses the words with the command's tables (and the options common to all commands) and runs it.
/// \param defaults  of the user, for options that are not among the words
void run(const Command& command,
         std::vector<std::string> words,
         std::span<const Default> defaults = {});

extern const Command init_command;       // app/init/command_init.cpp
extern const Command identify_command;   // app/profile/command_identify.cpp
extern const Command inspect_command;    // app/inspect/command_inspect.cpp
extern const Command import_command;     // app/import/command_import.cpp
extern const Command watch_command;      // app/watch/command_watch.cpp
extern const Command calibrate_command;  // app/store/command_calibrate.cpp
extern const Command reprocess_command;  // app/reprocess/command_reprocess.cpp
extern const Command valid_from_command; // app/store/command_valid_from.cpp
extern const Command forget_command;     // app/store/command_forget.cpp
extern const Command privacy_command;    // app/store/command_privacy.cpp
extern const Command publish_command;    // app/store/command_publish.cpp
extern const Command upgrade_command;    // app/store/command_upgrade.cpp
extern const Command query_command;      // app/query/command_query.cpp
extern const Command export_command;     // app/export/command_export.cpp
extern const Command render_command;     // app/render/command_render.cpp
extern const Command report_command;     // app/report/command_report.cpp
extern const Command compare_command;    // app/compare/command_compare.cpp
extern const Command info_command;       // app/store/command_info.cpp
extern const Command iri_command;        // app/profile/command_iri.cpp
extern const Command trace_command;      // app/trace/command_trace.cpp
extern const Command match_command;      // app/trace/command_match.cpp
extern const Command convert_command;    // app/trace/command_convert.cpp
extern const Command vehicles_command;   // app/vehicles/command_vehicles.cpp
extern const Command simulate_command;   // app/simulate/command_simulate.cpp

} // namespace macadam
