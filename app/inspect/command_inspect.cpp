#include "app/cli/commands.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/import/trip_inputs.hpp"
#include "app/inspect/companion_logs.hpp"
#include "app/inspect/inspection_output.hpp"
#include "app/pipeline/column_mapping_option.hpp"

#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_file.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace macadam {
namespace {

/// Results of all inspections of a call.
struct Inspected {
    std::vector<std::string> json{};
    std::vector<Inspection> logs{}; ///< of other programs
    std::size_t count = 0;
    std::size_t failed = 0; ///< not recognised, or damaged
};

void write_mapping(const std::filesystem::path& output,
                   const std::vector<std::filesystem::path>& inputs,
                   const Inspected& inspected,
                   const Console& console) {
    const auto companions = companions_in(inspected.logs);
    const bool is_pair = companions && inspected.logs.size() == 2;
    if (inspected.logs.size() != 1 && !is_pair) {
        throw InputError{
            fmt::format("{}: not written: -o takes one CSV file of another program, or two of "
                        "one trip, found {}",
                        output.string(),
                        inspected.logs.size())};
    }
    refuse_to_replace(output, inputs);
    AtomicFile file{output};
    file.write(is_pair ? mapping_of(*companions) : inspected.logs.front().mapping);
    file.commit();
    console.say(fmt::format("{}: mapping written; for --mapping", output.string()));
}

void add(const Inspection& found, bool json, bool with_mapping, Inspected& to) {
    ++to.count;
    to.failed += found.error.empty() && found.kind.use != FileKind::Use::unknown ? 0U : 1U;
    if (found.finds_columns()) {
        to.logs.push_back(found);
    }
    if (json) {
        to.json.push_back(inspection_json(found));
        return;
    }
    print_words(inspection_text(found));
    if (with_mapping && found.finds_columns()) {
        print_words("\n" + found.mapping + "\n");
    }
    flush_results();
}

void run_inspect(const Arguments& arguments, const Console& console) {
    const auto& words = arguments.operands("FILE");
    const std::vector<std::filesystem::path> paths{words.begin(), words.end()};
    const auto output = arguments.value("--output");
    const bool json = arguments.flag("--json");
    const auto max_files = max_members_of(arguments);
    if (output) {
        refuse_to_replace(*output, paths);
    }
    const auto mapping = mapping_of(arguments);
    Inspected inspected;
    for (const auto& path : paths) {
        const auto search = console.progress("looking for logs", {.name = "file"});
        inspect(path, mapping, max_files, search, [&](const Inspection& found) {
            add(found, json, !output, inspected);
        });
    }
    if (json) {
        print(fmt::format("[{}]\n", fmt::join(inspected.json, ",\n ")));
    }
    if (const auto pair = companions_in(inspected.logs); pair && !json && !output) {
        print_words(fmt::format("{} and {}: one trip in two files, accelerations in one and "
                                "positions of the same time in the other; for a mapping of both: "
                                "macadam inspect FILE FILE -o logger.toml\n",
                                pair->motion->name,
                                pair->positions->name));
    }
    if (output) {
        write_mapping(*output, paths, inspected, console);
    }
    if (inspected.failed > 0) {
        throw InputError{fmt::format("{} of {} not recognised or not readable",
                                     inspected.failed,
                                     counted(inspected.count, "file"))};
    }
}

constexpr std::array operands{Operand{
    .name = "FILE",
    .help = "Any files, folders or archives: logs, maps, profiles, surveys, databases, settings.",
    .many = true}};

constexpr std::array options{Option{"-o,--output",
                                    "FILE.toml",
                                    "Write the mapping of a CSV file, or of two of one trip, for "
                                    "--mapping; otherwise print it."},
                             mapping_option,
                             max_members_option,
                             Option{"--json", "", "One JSON array with an object per file."}};

} // namespace

const Command inspect_command{
    .name = "inspect",
    .summary = "Recognise files: what they are, what they hold and which command takes them",
    .about =
        "Recognises trip logs, phone exports, maps, profiles, surveys, databases and settings. For "
        "a log it prints\n"
        "duration, rates, gaps, quality of the positions, gravity, tilt and speeds, and what can "
        "be "
        "estimated from it.\n"
        "For a CSV file of another program it finds separator, header, columns and units by their "
        "names "
        "and values,\n"
        "says how sure each is, and prints a mapping file in which what was not found is marked. "
        "'import', "
        "'trace',\n"
        "'match' and 'convert' read such a file without a mapping if all that they need is sure.",
    .example =
        "  macadam inspect drive.csv\n"
        "  macadam inspect drive.csv -o logger.toml      then: macadam import STORE drive.csv "
        "--mapping logger.toml\n"
        "  macadam inspect downloads/ --json",
    .operands = operands,
    .options = options,
    .run = run_inspect};

} // namespace macadam
