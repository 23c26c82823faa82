#include "app/cli/commands.hpp"

#include "app/cli/interrupt_handler.hpp"
#include "storage/atomic/temporary_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace macadam {
namespace {

constexpr Option quiet{"--quiet", "", "Print only warnings and errors."};

std::vector<Option> options_of(const Command& command) {
    std::vector<Option> options{command.options.begin(), command.options.end()};
    options.push_back(quiet);
    return options;
}

std::string described(std::string_view term, std::string_view text) {
    constexpr std::size_t column = 26;
    if (term.size() + 2 >= column) {
        return fmt::format("  {}\n  {:{}}{}\n", term, "", column, text);
    }
    return fmt::format("  {:{}}{}\n", term, column, text);
}

std::string described(const Option& option) {
    auto term = std::string{option.name};
    std::replace(term.begin(), term.end(), ',', ' ');
    if (!option.value.empty()) {
        term += fmt::format(" {}{}", option.value, option.many ? "..." : "");
    }
    auto text = std::string{option.help};
    if (!option.fallback.empty()) {
        text += fmt::format(" [{}]", option.fallback);
    }
    return described(term, text);
}

/// Reports unfinished files that killed programs left beside their outputs.
void say_what_was_left(const Command& command, const Arguments& arguments, const Console& console) {
    std::vector<std::string> made;
    if (command.name == init_command.name) {
        made.push_back(arguments.operand("STORE"));
    }
    for (const auto& option : command.options) {
        if (option.name == "-o,--output") {
            made = arguments.values("--output");
        }
    }
    for (const auto& output : made) {
        for (const auto& [name, bytes] : leftovers_of(output)) {
            console.warn(fmt::format("{}: left behind by a run that was killed ({:.1f} MB); it "
                                     "is not needed and can be deleted",
                                     name.string(),
                                     static_cast<double>(bytes) / 1e6));
        }
    }
}

} // namespace

std::span<const Command> commands() {
    static const std::array table{
        init_command,    import_command,   calibrate_command, reprocess_command, valid_from_command,
        forget_command,  privacy_command,  publish_command,   upgrade_command,   query_command,
        export_command,  render_command,   report_command,    compare_command,   info_command,
        iri_command,     identify_command, trace_command,     match_command,     convert_command,
        simulate_command};
    return table;
}

const Command* command_named(std::string_view name) {
    const auto found = std::ranges::find(commands(), name, &Command::name);
    return found == commands().end() ? nullptr : &*found;
}

std::string usage_of(const Command& command) {
    auto usage = fmt::format("macadam {}", command.name);
    for (const auto& operand : command.operands) {
        const auto words = fmt::format("{}{}", operand.name, operand.many ? "..." : "");
        usage += operand.optional ? fmt::format(" [{}]", words) : " " + words;
    }
    return usage + " [OPTION...]";
}

std::string help_of(const Command& command) {
    auto help =
        fmt::format("{}\n\nusage: {}\n\n{}\n", command.summary, usage_of(command), command.about);
    if (!command.operands.empty()) {
        help += '\n';
        for (const auto& operand : command.operands) {
            help += described(operand.name, operand.help);
        }
    }
    help += "\noptions\n";
    for (const auto& option : options_of(command)) {
        help += described(option);
    }
    return help + fmt::format("\nexample\n{}\n", command.example);
}

std::string help_of_all() {
    std::string help =
        "Macadam: road roughness maps from the sensors that ordinary cars already have\n\n"
        "usage: macadam COMMAND ...    macadam COMMAND --help    macadam --version\n\n";
    for (const auto& command : commands()) {
        help += described(command.name, command.summary);
    }
    return help + "\n"
                  "From a trip to a map:\n"
                  "  macadam init roads.gpkg --network town.osm.pbf\n"
                  "  macadam import roads.gpkg trips/\n"
                  "  macadam render roads.gpkg -o map.png\n"
                  "\n"
                  "STORE is a road database: one .gpkg file that 'macadam init' makes.\n"
                  "Exit status: 0 success, 1 failure, 2 usage error.\n";
}

void run(const Command& command, std::vector<std::string> words) {
    const auto options = options_of(command);
    const Arguments arguments{options, command.operands, std::move(words)};
    const InterruptHandler interruption{command.name};
    const Console console{arguments.flag("--quiet"), interruption.stop()};
    say_what_was_left(command, arguments, console);
    command.run(arguments, console);
    flush_results();
}

} // namespace macadam
