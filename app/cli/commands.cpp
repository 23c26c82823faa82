#include "app/cli/commands.hpp"

#include "app/cli/interrupt_handler.hpp"
#include "storage/atomic/temporary_folder.hpp"
#include "storage/text/spelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

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
    auto text = std::string{option.help};
    if (!option.fallback.empty()) {
        text += fmt::format(" [{}]", option.fallback);
    }
    return described(term_of(option), text);
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
        init_command,       inspect_command, import_command,   calibrate_command, reprocess_command,
        valid_from_command, forget_command,  privacy_command,  publish_command,   upgrade_command,
        query_command,      export_command,  render_command,   report_command,    compare_command,
        info_command,       iri_command,     identify_command, trace_command,     match_command,
        convert_command,    simulate_command};
    return table;
}

const Command* command_named(std::string_view name) {
    const auto found = std::ranges::find(commands(), name, &Command::name);
    return found == commands().end() ? nullptr : &*found;
}

std::string refusal_of_command(std::string_view name) {
    std::vector<std::string> names{"help"};
    std::ranges::transform(commands(), std::back_inserter(names), [](const Command& command) {
        return std::string{command.name};
    });
    const auto nearest = suggestion(name, names);
    return fmt::format("unknown command '{}'{}",
                       name,
                       nearest.empty() ? "; macadam --help lists all commands" : nearest);
}

std::string usage_of(const Command& command) {
    auto usage = fmt::format("macadam {}", command.name);
    for (const auto& operand : command.operands) {
        const auto words = fmt::format("{}{}", operand.name, operand.many ? "..." : "");
        usage += operand.optional ? fmt::format(" [{}]", words) : " " + words;
    }
    return usage + " [OPTION...]";
}

std::vector<OptionGroup> option_groups_of(const Command& command) {
    std::vector<OptionGroup> groups{{"options", {}}};
    for (const auto& option : command.options) {
        const auto title = option.group.empty() ? groups.front().title : option.group;
        auto group = std::ranges::find(groups, title, &OptionGroup::title);
        if (group == groups.end()) {
            group = groups.insert(group, {title, {}});
        }
        group->options.push_back(option);
    }
    groups.front().options.push_back(quiet);
    return groups;
}

std::string term_of(const Option& option) {
    auto term = std::string{option.name};
    std::ranges::replace(term, ',', ' ');
    return option.value.empty()
               ? term
               : fmt::format("{} {}{}", term, option.value, option.many ? "..." : "");
}

std::string help_of(const Command& command, HelpDetail detail) {
    auto help =
        fmt::format("{}\n\nusage: {}\n\n{}\n", command.summary, usage_of(command), command.about);
    if (!command.operands.empty()) {
        help += '\n';
        for (const auto& operand : command.operands) {
            help += described(operand.name, operand.help);
        }
    }
    std::size_t hidden = 0;
    for (const auto& [title, options] : option_groups_of(command)) {
        std::string lines;
        for (const auto& option : options) {
            const bool shown = detail == HelpDetail::all || !option.rare;
            lines += shown ? described(option) : "";
            hidden += shown ? 0U : 1U;
        }
        help += lines.empty() ? "" : fmt::format("\n{}\n{}", title, lines);
    }
    if (hidden > 0) {
        help += fmt::format("\n{} rarely needed: macadam {} --help-all\n",
                            hidden == 1 ? "One more option is"
                                        : fmt::format("{} more options are", hidden),
                            command.name);
    }
    return help + fmt::format("\nexample\n{}\n", command.example);
}

std::string help_of_all() {
    std::string help =
        "Macadam: road roughness maps from the sensors that ordinary cars already have\n\n"
        "usage: macadam COMMAND ...    macadam help COMMAND    macadam --version\n\n";
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
    for (const auto& note : arguments.notes()) {
        console.say(fmt::format("macadam: note: {}", note));
    }
    say_what_was_left(command, arguments, console);
    command.run(arguments, console);
    flush_results();
}

} // namespace macadam
