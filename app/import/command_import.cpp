#include "app/cli/commands.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/server_store.hpp"
#include "app/import/import_outcome.hpp"
#include "app/import/import_references.hpp"
#include "app/import/import_run.hpp"
#include "app/import/trip_options.hpp"

#include "estimator/common/error.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/surveys/control_reader.hpp"

#include <fmt/format.h>

#include <array>

namespace macadam {
namespace {

void import_known(ImportStore& store,
                  const KnownRoughness& known,
                  bool json,
                  const Console& console) {
    const auto roads =
        load_or_build_network(store.map, [&](const std::string& words) { console.say(words); });
    if (known.survey) {
        const auto outcome = import_survey(*store.trips, roads, known);
        if (json) {
            print(json_line(outcome));
        } else if (!console.is_quiet()) {
            print_words(text_lines(outcome));
        } else {
            for (const auto& warning : outcome.warnings) {
                console.warn(fmt::format("{}: {}", outcome.file, warning));
            }
        }
        flush_results();
    }
    if (known.control) {
        const auto sections = read_control_sections(*known.control, roads, known.mm_per_m_of_one);
        opened_store(store.name, console).maintenance.put_control_sections(sections);
        console.say(fmt::format("{}: {} stored; 'macadam info' compares the cars with them",
                                known.control->string(),
                                counted(sections.size(), "control section")));
    }
}

void fuse_new(ImportStore& store, const Console& console) {
    const auto fused = fuse_new_passes(store, console);
    console.say(fmt::format("{} fused", counted(fused, "segment")));
}

void run_import(const Arguments& arguments, const Console& console) {
    const auto known = parse_known_roughness(arguments);
    const auto& paths = arguments.operands("PATH");
    if (paths.empty() && !known.survey && !known.control) {
        throw UsageError{"PATH is missing"};
    }
    const auto file = file_or_server(arguments);
    auto options = parse_import(arguments);
    options.readmit = arguments.flag("--take-back");
    VehicleChoice vehicles{arguments};
    auto store = opened_for_import(file, console);
    warn_of_importer(store, console);
    if (known.survey || known.control) {
        constexpr const char* name = "reference";
        store.trips->begin_import(name, 0);
        import_known(store, known, options.json, console);
        store.trips->end_import(name);
        if (paths.empty()) {
            fuse_new(store, console);
            return;
        }
    }
    const auto totals =
        import_paths(store, {paths.begin(), paths.end()}, options, vehicles, console);
    warn_of_earlier_settings(totals, file, paths.front(), console);
    const auto asked = totals.looked_at();
    if (asked == 0) {
        throw InputError{"no trip log was found: nothing was imported"};
    }
    expect_on_map(totals, store.map, console);
    if (totals.rejected > 0) {
        throw InputError{
            fmt::format("{} of {} rejected{}",
                        totals.rejected,
                        counted(asked, "trip"),
                        totals.rejected < asked ? "; the others are in the database" : "")};
    }
}

constexpr std::array operands{
    import_operand,
    Operand{"PATH",
            "Trip logs, phone exports, folders containing them (at any depth) or archives (.zip, "
            ".tar.gz).",
            true,
            "",
            true}};

constexpr auto options = trip_options_and(
    std::array{trim_option,
               Option{"--take-back", "", "Re-admit trips that 'macadam forget' deleted."},
               reference_option,
               accuracy_option,
               reference_date_option,
               reference_name_option,
               control_option,
               known_unit_option});

} // namespace

const Command import_command{
    .name = "import",
    .summary = "Import trip logs: each trip once, every row accounted for",
    .about =
        "Reads each trip, estimates the roughness of its road, matches it to the road network "
        "and cuts it into\n"
        "passes over segments; then fuses all passes over each segment. A trip reported as "
        "imported is on disk;\n"
        "trips that follow each other within a second are committed together. A trip that is "
        "already in the\n"
        "database, under any name or compression, is skipped; one that touches no road of the map "
        "is "
        "not stored\n"
        "('outside'). A trip that cannot be used is rejected with the reason and does not stop the "
        "others; the exit\n"
        "status is then 1, as it is if all trips are outside the map.\n"
        "--reference and --control import surveys and control sections instead of trips; PATH "
        "may be omitted.",
    .example = "  macadam import roads.gpkg trips/                     every log under trips/\n"
               "  macadam import roads.gpkg a.trip.csv.gz --vehicle generic\n"
               "  macadam import roads.gpkg trips/ --jobs 2 --json > import.jsonl\n"
               "  macadam import roads.gpkg --reference laser.csv --date 2026-03-01   "
               "(docs/reference/reference-surveys.md)",
    .operands = operands,
    .options = options,
    .run = run_import};

} // namespace macadam
