#include "app/cli/commands.hpp"

#include "app/cli/interrupt_handler.hpp"
#include "app/cli/server_commands.hpp"
#include "app/terminal/text_style.hpp"
#include "storage/atomic/temporary_folder.hpp"
#include "storage/text/spelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include <sys/resource.h>
#include <unistd.h>

namespace macadam {
namespace {

constexpr std::array common_options{
    preference({"--quiet", "", "Print only warnings and errors."}),
    preference({"--verbose", "", "Also tell what is read, chosen and done, with times."})};

std::string heading(std::string_view words, int stream = STDOUT_FILENO) {
    return styled(TextStyle::heading, words, stream);
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

Verbosity verbosity_of(const Arguments& arguments) {
    if (arguments.is_given("--quiet") && arguments.is_given("--verbose")) {
        throw UsageError{"--quiet and --verbose cannot be combined"};
    }
    const bool prefers_quiet = !arguments.is_given("--verbose") && arguments.flag("--quiet");
    return prefers_quiet                 ? Verbosity::quiet
           : arguments.flag("--verbose") ? Verbosity::verbose
                                         : Verbosity::normal;
}

/// Tells the options in force that are not built-in defaults, and where they come from.
void tell_settings(std::span<const Option> options,
                   const Arguments& arguments,
                   const Console& console) {
    for (const auto& option : options) {
        const auto name = long_name(option);
        const auto values = arguments.values(name);
        const auto found = std::ranges::find(arguments.defaults(), name, &Default::option);
        if (!values.empty()) {
            console.detail(
                fmt::format("{}{} ({})",
                            name,
                            option.value.empty() ? "" : fmt::format(" {}", fmt::join(values, " ")),
                            found == arguments.defaults().end() ? "command line" : found->source));
        }
    }
}

/// Adds to a refusal where the options that it names got their defaults.
std::string with_sources(std::string refusal, const Arguments& arguments) {
    const auto words = refusal;
    for (const auto& [option, value, source] : arguments.defaults()) {
        if (words.find(option + " ") != std::string::npos) {
            refusal += fmt::format("; {} {} comes from {}", option, value, source);
        }
    }
    return refusal;
}

double peak_memory_mb() {
    struct rusage usage {};
    getrusage(RUSAGE_SELF, &usage);
    constexpr double kb_per_mb = 1000;
    return static_cast<double>(usage.ru_maxrss) * 1.024 / kb_per_mb;
}

/// Names the options of the command's own table whose defaults users may set.
std::string preference_line(const Command& command) {
    std::vector<std::string> names;
    for (const auto& option : command.options) {
        if (option.is_preference) {
            names.push_back(long_name(option));
        }
    }
    return names.empty() ? ""
                         : fmt::format("\nSet your own defaults of {}: macadam help config\n",
                                       fmt::join(names, ", "));
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
        init_command,      inspect_command,    import_command,  watch_command,   calibrate_command,
        reprocess_command, valid_from_command, forget_command,  privacy_command, publish_command,
        upgrade_command,   copy_command,       cells_command,   query_command,   export_command,
        render_command,    report_command,     serve_command,   token_command,   submit_command,
        worker_command,    status_command,     compare_command, info_command,    iri_command,
        identify_command,  trace_command,      match_command,   convert_command, vehicles_command,
        simulate_command};
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
    std::ranges::copy(common_options, std::back_inserter(groups.front().options));
    return groups;
}

std::vector<Option> options_of(const Command& command) {
    std::vector<Option> options{command.options.begin(), command.options.end()};
    std::ranges::copy(common_options, std::back_inserter(options));
    return options;
}

std::string term_of(const Option& option) {
    auto term = std::string{option.name};
    std::ranges::replace(term, ',', ' ');
    return option.value.empty()
               ? term
               : fmt::format("{} {}{}", term, option.value, option.many ? "..." : "");
}

std::string help_of(const Command& command, HelpDetail detail) {
    auto help = fmt::format("{}\n\n{} {}\n\n{}\n",
                            heading(command.summary),
                            heading("usage:"),
                            usage_of(command),
                            command.about);
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
        help += lines.empty() ? "" : fmt::format("\n{}\n{}", heading(title), lines);
    }
    if (hidden > 0) {
        help += fmt::format("\n{} rarely needed: macadam {} --help-all\n",
                            hidden == 1 ? "One more option is"
                                        : fmt::format("{} more options are", hidden),
                            command.name);
    }
    return help + preference_line(command) +
           fmt::format("\n{}\n{}\n", heading("example"), command.example);
}

std::string help_of_all(int stream) {
    auto help =
        heading("Macadam: road roughness maps from the sensors that ordinary cars already have",
                stream) +
        "\n\n" + heading("usage:", stream) +
        " macadam COMMAND ...    macadam help COMMAND    macadam --version\n\n";
    for (const auto& command : commands()) {
        help += described(command.name, command.summary);
    }
    return help + "\n" + heading("From a trip to a map:", stream) +
           "\n"
           "  macadam init roads.gpkg --network town.osm.pbf\n"
           "  macadam import roads.gpkg trips/\n"
           "  macadam render roads.gpkg -o map.png\n"
           "\n"
           "STORE is a road database: one .gpkg file that 'macadam init' makes.\n"
           "Defaults of options: a configuration file and variables; see macadam help config.\n"
           "Exit status: 0 success, 1 failure, 2 usage error.\n";
}

void run(const Command& command,
         std::vector<std::string> words,
         std::span<const Default> defaults) {
    const auto options = options_of(command);
    Arguments arguments{options, command.operands, std::move(words)};
    arguments.adopt(defaults);
    const auto verbosity = verbosity_of(arguments);
    const InterruptHandler interruption{command.name,
                                        {.is_quiet = verbosity == Verbosity::quiet,
                                         .runs_until_stopped = command.runs_until_stopped}};
    const Console console{verbosity, interruption.stop()};
    tell_settings(options, arguments, console);
    for (const auto& note : arguments.notes()) {
        console.say(fmt::format("macadam: note: {}", note));
    }
    say_what_was_left(command, arguments, console);
    try {
        command.run(arguments, console);
    } catch (const UsageError& error) {
        throw UsageError{with_sources(error.what(), arguments)};
    }
    flush_results();
    console.detail(fmt::format("done, with at most {:.0f} MB of memory", peak_memory_mb()));
}

} // namespace macadam
