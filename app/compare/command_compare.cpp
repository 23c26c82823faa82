#include "app/cli/commands.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/cli/row_output.hpp"
#include "app/compare/comparison_output.hpp"
#include "app/compare/source_comparison.hpp"
#include "app/database/period_options.hpp"
#include "app/database/segment_options.hpp"
#include "app/database/selection.hpp"
#include "app/output/units_option.hpp"

#include "mapping/style/iri_class.hpp"
#include "render/report/document/pdf.hpp"
#include "render/report/report.hpp"
#include "storage/atomic/atomic_file.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

namespace fs = std::filesystem;

SourceOption
parse_source(const Arguments& arguments, std::string_view operand, std::string_view car) {
    const fs::path file = arguments.operand(operand);
    const SourceOption source{file, kind_of_source(file), arguments.value(car)};
    if (source.car && source.kind != SourceKind::database) {
        throw UsageError{fmt::format(
            "{} requires a road database, but {} is '{}'", car, operand, file.string())};
    }
    return source;
}

double
parse_length(const Arguments& arguments, std::string_view name, double fallback, double most) {
    const double length_m = arguments.number(name, fallback);
    if (!(length_m > 0 && length_m <= most)) {
        throw UsageError{
            fmt::format("{} is {}, expected metres above 0, up to {}", name, length_m, most)};
    }
    return length_m;
}

void expect_two_sources(const CompareOptions& options) {
    std::error_code ignored;
    if (fs::equivalent(options.a.file, options.b.file, ignored) && options.a.car == options.b.car) {
        throw UsageError{
            options.a.kind == SourceKind::database
                ? "A and B are the same database; --car-a and --car-b select two of its "
                  "cars"
                : "A and B are the same file"};
    }
    const bool are_surveys =
        options.a.kind == SourceKind::survey && options.b.kind == SourceKind::survey;
    if (are_surveys && !options.roads) {
        throw UsageError{"two surveys need the roads of a database; add --roads STORE.gpkg"};
    }
    if (!are_surveys && options.roads) {
        throw UsageError{"--roads requires two surveys"};
    }
}

void expect_none_of(const Arguments& arguments,
                    std::initializer_list<std::string_view> names,
                    std::string_view why) {
    for (const auto name : names) {
        if (arguments.value(name)) {
            throw UsageError{fmt::format("{} {}", name, why)};
        }
    }
}

/// Refuses options that would have no effect on these sources.
void expect_effect(const Arguments& arguments, const CompareOptions& options) {
    const auto count = [&](SourceKind kind) {
        return (options.a.kind == kind ? 1 : 0) + (options.b.kind == kind ? 1 : 0);
    };
    if (count(SourceKind::profile) == 2) {
        expect_none_of(arguments,
                       {"--bbox", "--way", "--road", "--highway", "--since", "--until"},
                       "selects roads or passes, but A and B are profiles, which have neither");
    }
    if (count(SourceKind::survey) == 2) {
        expect_none_of(arguments,
                       {"--since", "--until"},
                       "selects passes of a road database, but A and B are surveys");
    }
    if (count(SourceKind::profile) == 0) {
        expect_none_of(arguments,
                       {"--step", "--length", "--max-lag"},
                       "requires two profiles, but neither A nor B is one");
    }
    if (count(SourceKind::survey) == 0) {
        expect_none_of(arguments, {"--unit"}, "is that of a survey, but neither A nor B is one");
    }
}

CompareOptions parse_compare(const Arguments& arguments) {
    constexpr double max_interval_m = 1000, max_lag_m = 100;
    CompareOptions options{
        .a = parse_source(arguments, "A", "--car-a"),
        .b = parse_source(arguments, "B", "--car-b"),
        .filter = parse_road_filter(arguments),
        .speeds_in_mph = parse_units(arguments) == UnitSystem::us,
        .roads = arguments.value("--roads"),
        .mm_per_m_of_one = arguments.choice("--unit") == "in/mi" ? 1 / in_per_mi_of_mm_per_m : 1,
        .step_m = arguments.number("--step"),
        .profiles = {}};
    options.profiles.max_lag_m =
        parse_length(arguments, "--max-lag", options.profiles.max_lag_m, max_lag_m);
    options.profiles.interval_m =
        parse_length(arguments, "--length", options.profiles.interval_m, max_interval_m);
    expect_two_sources(options);
    expect_effect(arguments, options);
    return options;
}

/// Files that -o names.
struct CompareOutput {
    std::optional<fs::path> page;
    std::optional<fs::path> rows; ///< `std::nullopt`: standard output
    std::string format;
};

CompareOutput parse_output(const Arguments& arguments) {
    CompareOutput output{.page = {},
                         .rows = row_file_of(arguments, {".html", ".pdf"}),
                         .format = row_format_of(arguments)};
    if (!output.rows) {
        output.page = arguments.value("--output");
    }
    return output;
}

void expect_replaceable(const CompareOutput& output, const CompareOptions& options) {
    std::vector<fs::path> inputs{options.a.file, options.b.file};
    if (options.roads) {
        inputs.push_back(*options.roads);
    }
    for (const auto& file : {output.page, output.rows}) {
        if (file) {
            refuse_to_replace(*file, inputs);
        }
    }
}

void write_page(const SourceComparison& comparison, const fs::path& output) {
    const auto document = comparison_document(comparison);
    AtomicFile file{output};
    file.write(output.extension() == ".pdf" ? pdf_of(document, {}) : html_of(document));
    file.commit();
}

void run_compare(const Arguments& arguments, const Console& console) {
    const auto output = parse_output(arguments);
    const auto options = parse_compare(arguments);
    expect_replaceable(output, options);
    const auto units = parse_units(arguments);
    const auto metric = compare_sources(options, console);
    const auto comparison = units == UnitSystem::us ? in_per_mi(metric) : metric;
    if (comparison.pairs.empty()) {
        console.warn(comparison.shared ? "the sources share no segment with a measurement"
                                       : "the profiles share less than one interval of --length");
    }
    if (output.page) {
        write_page(comparison, *output.page);
    }
    RowOutput rows{output.rows};
    if (output.format == "table") {
        print_words(comparison_text(comparison));
    } else {
        print(output.format == "json" ? comparison_json(comparison)
                                      : comparison_csv(metric, units));
    }
    rows.commit();
}

constexpr std::array operands{
    Operand{"A", "A road database (.gpkg), a survey (.csv) or a profile (.csv, .txt, .erd, .pro)."},
    Operand{"B", "The source to compare with; usually the better one, such as a reference."}};
constexpr std::array options{
    Option{"-o,--output",
           "FILE",
           "Write a page, .html or .pdf, beside the tables; or the tables to this .csv or .json."},
    one_of("table|csv|json", {"--format", "NAME", "table, csv or json.", "table"}),
    json_option,
    Option{"--car-a",
           "ID",
           "Only this car of database A, by vehicle_id or by pseudonym ('macadam info')."},
    Option{"--car-b", "ID", "Only this car of database B."},
    bbox_option,
    way_option,
    road_option,
    highway_option,
    since_option,
    until_option,
    Option{"--roads", "STORE", "Road database on whose roads two surveys are compared."},
    one_of("mm/m|in/mi", {"--unit", "UNIT", "IRI unit of surveys: mm/m or in/mi.", "mm/m"}),
    units_option,
    Option{"--step", "METRES", "Spacing of the points of profiles, as in 'macadam iri'."},
    Option{"--length", "METRES", "Interval of profiles whose IRI is compared.", "20"},
    Option{"--max-lag", "METRES", "Largest shift of one profile along the other.", "5"}};

} // namespace

const Command compare_command{
    .name = "compare",
    .summary = "Compare two sources: databases, cars, surveys, profiles",
    .about =
        "Databases and surveys are compared segment by segment: bias (mean of A - B) and limits of "
        "agreement\n"
        "(Bland and Altman), in all and by road class, roughness, speed and car. Their 95 % "
        "intervals allow for\n"
        "the likeness of neighbouring segments. Surveys inside a database do not count: its cars "
        "are compared.\n"
        "Of a crowd database only published values are compared, without speeds and cars.\n"
        "Profiles are compared by cross-correlation after the filter of IRI and in bands of long, "
        "medium and\n"
        "short waves, with the thresholds of AASHTO R 56 (docs/reference/compare.md).",
    .example =
        "  macadam compare roads.gpkg laser.csv -o agreement.html   cars against a survey\n"
        "  macadam compare spring.gpkg autumn.gpkg                  two databases of one map\n"
        "  macadam compare roads.gpkg roads.gpkg --car-a van-7 --car-b van-9\n"
        "  macadam compare a1.csv a2.csv --roads roads.gpkg         two surveys\n"
        "  macadam compare run1.erd run2.erd --json                 two runs of a profiler",
    .operands = operands,
    .options = options,
    .run = run_compare};

} // namespace macadam
