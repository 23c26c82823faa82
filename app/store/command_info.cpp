#include "app/cli/commands.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/cli/row_output.hpp"
#include "app/cli/row_writer.hpp"
#include "app/database/key_messages.hpp"
#include "app/database/publication_messages.hpp"
#include "app/database/segment_options.hpp"
#include "app/database/server_store.hpp"
#include "app/import/alignment_summary.hpp"
#include "app/output/units_option.hpp"
#include "app/query/audit_output.hpp"
#include "app/report/control_monitoring.hpp"
#include "app/store/info_tables.hpp"
#include "app/store/truth_output.hpp"

#include "storage/text/json.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

constexpr std::string_view all_tables = "all"; // of --table

double share(double part, double whole) {
    return whole > 0 ? part / whole : 0;
}

std::string json_of(const AlignmentSummary& alignment, UnitSystem units) {
    const bool us = units == UnitSystem::us;
    JsonObject object;
    object.add("drives", alignment.drives)
        .add("found", alignment.found)
        .add("beyond_reach", alignment.beyond_reach)
        .add("moved_far", alignment.moved_far)
        .add(us ? "middle_lag_ft" : "middle_lag_m",
             alignment.found > 0
                 ? json_number(alignment.middle_lag_cm / 100.0 * (us ? ft_of_m : 1), 2)
                 : JsonValue{nullptr});
    return object.text();
}

/// Reference surveys and control sections of a database.
struct KnownRoads {
    std::vector<SurveyUse> surveys;
    std::vector<WatchedSection> controls;
};

std::string text_of(const KnownRoads& known, UnitSystem units) {
    std::string text;
    if (!known.surveys.empty()) {
        text.append("\n").append(table_text(survey_columns(units), known.surveys));
    }
    if (!known.controls.empty()) {
        text.append("\n").append(table_text(control_section_columns(units), known.controls));
    }
    return text;
}

const Columns<StoreInfo> length_columns{
    {"km", as::real(3, "km"), [](auto& r) { return r.km; }},
    {"network_km", as::real(3, "km"), [](auto& r) { return r.network_km; }}};

/// Formats the report as JSON.
/// \param truth  JSON; "" = not requested
std::string json_of(const StoreInfo& info,
                    const InfoTables& tables,
                    const KnownRoads& known,
                    bool operates,
                    const std::string& digest,
                    const std::string& truth,
                    UnitSystem units) {
    const auto whole = [](std::size_t n) { return static_cast<std::int64_t>(n); };
    JsonObject object;
    object.add("trips", whole(info.trips))
        .add("undated_trips", whole(info.undated_trips))
        .add("passes", whole(info.passes))
        .add("passes_lateral_alone", whole(info.lateral_passes))
        .add("vehicles", JsonRaw{json_string_array(info.vehicles)})
        .add("segments", whole(info.segments))
        .add("segments_with_passes", whole(info.segments_with_passes));
    for (const auto& [name, type, value, shown] : in_units(length_columns, units)) {
        object.add(name, json_value(type, value(info)));
    }
    object.add("classes", JsonRaw{class_lengths_json(info.classes, info.km, units)})
        .add("laid_on_others", JsonRaw{json_of(info.alignment, units)});
    add_to(object, tables, units);
    if (info.settings.max_trips_per_car_month > 0) {
        object.add("max_trips_per_car_month", info.settings.max_trips_per_car_month);
    }
    if (info.settings.kept_logs.days > 0) {
        object.add("kept_logs_days", info.settings.kept_logs.days);
    }
    object.add("privacy", std::string{name_of(info.settings.privacy)}).add("operator", operates);
    if (info.settings.privacy == PrivacyProfile::crowd) {
        object.add("publication", JsonRaw{json_of(info.publication)})
            .add("published_alone", info.published_alone);
    }
    object.add("surveys", JsonRaw{json_rows(survey_columns(units), known.surveys)})
        .add("control_sections",
             JsonRaw{json_rows(control_section_columns(units), known.controls)});
    object.add("generation", std::int64_t{info.generation}).add("digest", digest);
    if (!truth.empty()) {
        object.add("truth", JsonRaw{truth});
    }
    return object.text() + "\n";
}

std::string period_of(const StoreInfo& info) {
    if (!info.first_seen_ms || !info.last_seen_ms) {
        return "undated";
    }
    const auto first = utc_day(*info.first_seen_ms);
    const auto last = utc_day(*info.last_seen_ms);
    return first == last ? first : fmt::format("{} to {}", first, last);
}

std::string_view words_for(PrivacyProfile privacy) {
    return privacy == PrivacyProfile::crowd ? "crowd: other people's cars"
                                            : "own: the operator's cars, nothing is anonymised";
}

std::string trips_of(const StoreInfo& info) {
    if (info.published_alone) {
        return fmt::format("at least {} of {} cars, {}",
                           info.trips,
                           info.publication ? info.publication->vehicles : 0,
                           counted(info.passes, "pass"));
    }
    return fmt::format("{} ({} undated), {}, {}",
                       info.trips,
                       info.undated_trips,
                       counted(info.vehicles.size(), "vehicle"),
                       counted(info.passes, "pass"));
}

std::string text_of(const StoreInfo& info, bool operates, UnitSystem units) {
    auto text = fmt::format("network     {}, {} counting each direction, {} segments of about {}\n"
                            "trips       {}\n"
                            "period      {}\n"
                            "covered     {}, {} segments ({:.1f} % of the network)\n"
                            "privacy     {}; vehicle key {}\n",
                            info.settings.network_source,
                            km_words(info.network_km, 1, units),
                            info.segments,
                            length_words(info.settings.segment_length_m, units),
                            trips_of(info),
                            period_of(info),
                            km_words(info.km, 2, units),
                            info.segments_with_passes,
                            100 * share(info.km, info.network_km),
                            words_for(info.settings.privacy),
                            operates ? "present" : "absent");
    if (info.settings.privacy == PrivacyProfile::crowd) {
        text += fmt::format("published   {}\n",
                            info.publication ? words_for(*info.publication) : "nothing yet");
    }
    if (const auto days = info.settings.kept_logs.days; days > 0) {
        text += fmt::format("logs        kept encrypted for {}\n",
                            counted(static_cast<std::size_t>(days), "day"));
    }
    if (const auto limit = info.settings.max_trips_per_car_month; limit > 0) {
        text += fmt::format("fused       at most {} of a car over a segment in a month\n",
                            counted(static_cast<std::size_t>(limit), "trip"));
    }
    if (info.lateral_passes > 0) {
        text += fmt::format("lateral     {} of the passes from lateral acceleration only, "
                            "which is far less accurate\n",
                            info.lateral_passes);
    }
    if (const auto words = alignment_summary_text(info.alignment, units); !words.empty()) {
        text += fmt::format("passes      {}\n", words);
    }
    for (const auto& [name, km] : info.classes) {
        text += fmt::format(
            "{:<12}{}, {:.1f} %\n", name, km_words(km, 2, units), 100 * share(km, info.km));
    }
    return text;
}

/// Formats the one table that --table names.
std::string one_table(const StoreReader& store,
                      std::string_view name,
                      const std::string& format,
                      UnitSystem units) {
    if (name == "classes") {
        const auto info = store.info();
        return rows_text(in_units(class_columns(info.km), units), info.classes, format);
    }
    if (name == "surveys") {
        return rows_text(survey_columns(units), store.surveys(), format);
    }
    if (name == "control-sections") {
        return rows_text(control_section_columns(units), watched_sections(store), format);
    }
    const auto tables = info_tables(store);
    return name == "cars" ? rows_text(car_columns(units), tables.cars, format)
           : name == "road-classes"
               ? rows_text(road_class_columns(units), tables.road_classes, format)
           : name == "months" ? rows_text(usage_columns("month"), months_of(tables.days), format)
                              : rows_text(usage_columns("day"), tables.days, format);
}

void print_info(const StoreReader& store, const Arguments& arguments, const std::string& format) {
    const auto print_rows = format == "table" ? print_words : print;
    const auto units = parse_units(arguments);
    if (arguments.flag("--digest")) {
        print(store.digest() + "\n");
        return;
    }
    if (arguments.flag("--audit")) {
        expect_operator(store, "audit entries");
        print_rows(audit_text(store.audit(), format));
        return;
    }
    if (const auto table = arguments.choice("--table"); table != all_tables) {
        print_rows(one_table(store, table, format, units));
        return;
    }
    std::optional<TruthComparison> truth;
    if (const auto truth_file = arguments.value("--truth")) {
        truth = compared(store, *truth_file);
    }
    if (truth && format == "csv") {
        print(csv_of(*truth, units));
        return;
    }
    const auto info = store.info();
    const auto tables = info_tables(store);
    const KnownRoads known{store.surveys(), watched_sections(store)};
    if (format == "json") {
        print(json_of(info,
                      tables,
                      known,
                      store.is_operator(),
                      store.digest(),
                      truth ? json_of(*truth, units) : "",
                      units));
    } else {
        print_words(text_of(info, store.is_operator(), units) + text_of(tables, units) +
                    text_of(known, units) + (truth ? "\n" + text_of(*truth, units) : ""));
    }
}

/// Rejects options that would have no effect, and CSV of more than one table.
void expect_one_result(const Arguments& arguments, std::string_view format) {
    std::vector<std::string_view> given;
    for (const auto* const name : {"--digest", "--audit", "--table", "--truth"}) {
        if (arguments.value(name).value_or(std::string{all_tables}) != all_tables) {
            given.emplace_back(name);
        }
    }
    if (given.size() > 1) {
        throw UsageError{fmt::format("{} cannot be combined", fmt::join(given, " and "))};
    }
    if (format == "csv" && (given.empty() || given.front() == "--digest")) {
        throw UsageError{"CSV holds one table, expected --table NAME, --audit or --truth FILE "
                         "with --format csv"};
    }
}

void run_info(const Arguments& arguments, const Console& console) {
    const auto file = file_or_server(arguments);
    const auto format = row_format_of(arguments);
    expect_one_result(arguments, format);
    const auto row_file = row_file_of(arguments);
    if (row_file) {
        refuse_to_replace(*row_file, {file});
    }
    const auto store = open_for_operator(file, console);
    warn_of_waiting(store, file, console);
    warn_of_open_key(store, console);
    RowOutput output{row_file};
    print_info(store, arguments, format);
    store.expect_in_place();
    output.commit();
}

constexpr std::array operands{source_operand};
constexpr std::array options{
    one_of("all|classes|road-classes|cars|months|days|surveys|control-sections",
           {"--table", "NAME", "Print only this table, with all its rows.", "all"}),
    one_of("table|csv|json",
           {"--format", "NAME", "table, json (with the digest), or csv of one table.", "table"}),
    row_output_option,
    json_option,
    units_option,
    Option{"--truth",
           "FILE.csv",
           "Compare with true values: a truth.csv of 'macadam simulate' or of a profiler."},
    Option{"--audit", "", "List the operations that changed values, with their times."},
    Option{"--digest",
           "",
           "Print only the digest: 64 hex digits, equal for equal content on any machine."}};

} // namespace

const Command info_command{
    .name = "info",
    .summary = "Show coverage, passes, vehicles and kilometres per class",
    .about = "Each direction of a road counts separately. Road classes are those of "
             "OpenStreetMap; a pass counts on the\nday on which its trip began.",
    .example = "  macadam info roads.gpkg\n"
               "  macadam info roads.gpkg --digest       has anything changed?\n"
               "  macadam info roads.gpkg --table cars -o cars.csv\n"
               "  macadam info fleet/roads.gpkg --truth fleet/truth.csv",
    .operands = operands,
    .options = options,
    .run = run_info};

} // namespace macadam
