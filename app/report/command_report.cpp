#include "app/cli/commands.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/database/empty_map_message.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/period_options.hpp"
#include "app/database/publication_messages.hpp"
#include "app/database/segment_options.hpp"
#include "app/render/style_options.hpp"
#include "app/report/reference_output.hpp"
#include "app/report/reference_report.hpp"
#include "app/report/report_data.hpp"

#include "render/report/document/pdf.hpp"
#include "storage/atomic/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace macadam {
namespace {

struct ReportOptions {
    std::filesystem::path store;
    std::filesystem::path output;
    ReportConfig report;
    PdfConfig pdf;
};

constexpr std::int64_t max_stretches = 200; // each has maps of about 100 kB

std::size_t parse_worst(const Arguments& arguments) {
    const auto worst =
        arguments.integer("--worst").value_or(static_cast<std::int64_t>(ReportConfig{}.worst));
    if (worst < 0 || worst > max_stretches) {
        throw UsageError{fmt::format("--worst is {}, expected 0 to {}", worst, max_stretches)};
    }
    return static_cast<std::size_t>(worst);
}

MapStyle parse_style(const Arguments& arguments) {
    auto style = parse_style_file(arguments);
    style.min_passes = grey_below(arguments).value_or(style.min_passes);
    style.left_hand_traffic = arguments.flag("--left-hand");
    if (const auto name = arguments.value("--classes")) {
        style.classes = class_table(*name);
    }
    return style;
}

/// Parses --language and --unit.
/// \param by_default  unit without --unit
Localisation parse_wording(const Arguments& arguments, IriUnit by_default) {
    Localisation wording{.unit = by_default};
    if (const auto code = arguments.value("--language")) {
        wording.language = language(*code);
    }
    if (const auto unit = arguments.value("--unit")) {
        wording.unit = *unit == "in/mi" ? IriUnit::in_per_mi : IriUnit::mm_per_m;
    }
    return wording;
}

/// Parses the paper options.
/// \param ending  suffix of the output
PdfConfig parse_paper(const Arguments& arguments, std::string_view ending) {
    PdfConfig config;
    if (const auto name = arguments.value("--paper")) {
        if (ending != ".pdf") {
            throw UsageError{"--paper requires -o FILE.pdf"};
        }
        config.paper = *name == "letter" ? us_letter : a4;
    }
    return config;
}

ReportOptions parse_report(const Arguments& arguments) {
    const auto output = arguments.value("--output");
    const auto ending = std::filesystem::path{output.value_or("")}.extension().string();
    if (ending != ".html" && ending != ".pdf") {
        throw UsageError{
            output ? fmt::format("-o is '{}', expected a name that ends in .html or .pdf", *output)
                   : std::string{"-o report.html is missing"}};
    }
    const auto style = parse_style(arguments);
    const auto wording =
        parse_wording(arguments, style.in_per_mi ? IriUnit::in_per_mi : IriUnit::mm_per_m);
    return {.store = store_file(arguments),
            .output = *output,
            .report = {.title = arguments.value("--title").value_or(wording("title")),
                       .worst = parse_worst(arguments),
                       .sections = parse_sections(arguments, false),
                       .since_ms = parse_begin(arguments, "--compare-since"),
                       .wording = wording,
                       .pictures = ending == ".pdf" ? PictureUse::paper : PictureUse::screen,
                       .style = style},
            .pdf = parse_paper(arguments, ending)};
}

/// Rejects options that the reference report does not support.
void refuse_beside_references(const Arguments& arguments) {
    for (const auto* const option :
         {"--worst", "--sections", "--classes", "--compare-since", "--style", "--grey-below"}) {
        if (arguments.value(option)) {
            throw UsageError{fmt::format("{} and --against-reference cannot be combined", option)};
        }
    }
}

/// Rejects --unit and --language for data formats, which are always in English and mm/m.
void refuse_for_programs(const Arguments& arguments) {
    for (const auto* const option : {"--unit", "--language"}) {
        if (arguments.value(option)) {
            throw UsageError{
                fmt::format("with --against-reference, {} requires -o FILE.html or .pdf", option)};
        }
    }
}

std::string text_for(const ReferenceReport& report, std::string_view ending, const PdfConfig& pdf) {
    return ending == ".html"   ? reference_html(report)
           : ending == ".pdf"  ? pdf_of(reference_document(report), pdf)
           : ending == ".json" ? reference_json(report)
                               : reference_csv(report);
}

void report_against_reference(const Arguments& arguments, const Console& console) {
    refuse_beside_references(arguments);
    const std::filesystem::path output = arguments.value("--output").value_or("");
    const auto ending = output.extension().string();
    constexpr std::array<std::string_view, 4> endings{".html", ".pdf", ".json", ".csv"};
    if (!output.empty() && std::ranges::find(endings, ending) == endings.end()) {
        throw UsageError{fmt::format("-o is '{}', expected a name that ends in .html, .pdf, .json "
                                     "or .csv",
                                     output.string())};
    }
    const auto pdf = parse_paper(arguments, ending);
    const auto wording = parse_wording(arguments, IriUnit::mm_per_m);
    if (ending != ".html" && ending != ".pdf") {
        refuse_for_programs(arguments);
    }
    const auto file = store_file(arguments);
    const auto store = opened_reader(file, console);
    warn_of_waiting(store, file, console);
    tell_publication(store, console);
    const auto report = reference_report(
        store, arguments.value("--title").value_or(wording("reference.title")), wording);
    if (output.empty()) {
        print_words(reference_text(report));
        store.expect_in_place();
        return;
    }
    refuse_to_replace(output, {file});
    store.expect_in_place();
    AtomicFile written{output};
    written.write(text_for(report, ending, pdf));
    written.commit();
}

void run_report(const Arguments& arguments, const Console& console) {
    if (arguments.flag("--against-reference")) {
        report_against_reference(arguments, console);
        return;
    }
    auto options = parse_report(arguments);
    const auto store = opened_reader(options.store, console);
    refuse_to_replace(options.output, {options.store});
    warn_of_waiting(store, options.store, console);
    warn_of_empty_map(store, console);
    tell_publication(store, console);
    if (options.report.style.classes == nullptr) {
        options.report.style.classes = class_table(store.settings().class_table);
    }
    warn_of_look(options.report.style, console);
    const auto document =
        report_document(report_of(store, options.report, console.progress("drawing maps")));
    const auto bytes = options.report.pictures == PictureUse::paper ? pdf_of(document, options.pdf)
                                                                    : html_of(document);
    store.expect_in_place();
    AtomicFile file{options.output};
    file.write(bytes);
    file.commit();
    console.say(fmt::format(
        "{}: {:.1f} MB", options.output.string(), static_cast<double>(bytes.size()) / 1e6));
}

constexpr std::array operands{store_operand};
constexpr std::array options{
    Option{"-o,--output", "FILE", "The report, an .html or .pdf file."},
    Option{"--against-reference",
           "",
           "Compare cars with reference surveys: -o FILE.html, .pdf, .json or .csv, or a table."},
    Option{"--title", "TEXT", "Title of the report.", "Road roughness"},
    instead_of(
        "--since",
        {"--compare-since", "DATE", "Report changes since this day: 2026-03-01 or 2026-03."}),
    one_of("mm/m|in/mi",
           in_group("appearance", {"--unit", "UNIT", "Unit of roughness: mm/m or in/mi.", "mm/m"})),
    one_of("en|de", in_group("appearance", {"--language", "CODE", "en or de.", "en"})),
    one_of(
        "A4|letter",
        in_group("appearance", {"--paper", "SIZE", "Paper size of a .pdf: A4 or letter.", "A4"})),
    Option{"--worst", "N", "Number of worst sections to list, each with a map.", "20"},
    sections_option,
    section_length_option,
    homogeneous_option,
    exclude_option,
    exclude_radius_option,
    one_of(
        "fhwa|five",
        in_group("appearance",
                 {"--classes", "NAME", "fhwa (good, fair, poor) or five.", "as in the database"})),
    style_option,
    instead_of("--min-passes", grey_below_option),
    in_group(
        "appearance",
        {"--left-hand", "", "Traffic keeps left: maps draw each direction on the left side."})};

} // namespace

const Command report_command{
    .name = "report",
    .summary = "Create a condition report: condition, worst sections, coverage, data",
    .about = "Writes one self-contained HTML file that opens in any browser, also on a phone; or a "
             "PDF for printing.\nThe same database gives the same bytes.",
    .example =
        "  macadam report roads.gpkg -o report.html --title \"Spring survey 2026\"\n"
        "  macadam report roads.gpkg -o report.pdf --compare-since 2026-04-01 --language de\n"
        "  macadam report roads.gpkg -o report.html --worst 50 --classes five\n"
        "  macadam report roads.gpkg --against-reference -o reference.html",
    .operands = operands,
    .options = options,
    .run = run_report};

} // namespace macadam
