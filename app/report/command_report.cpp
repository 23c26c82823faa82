#include "app/cli/commands.hpp"
#include "app/cli/joined_options.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/cli/row_output.hpp"
#include "app/cli/terminal_escape.hpp"
#include "app/database/empty_map_message.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/database/publication_messages.hpp"
#include "app/database/selection.hpp"
#include "app/database/server_store.hpp"
#include "app/output/units_option.hpp"
#include "app/render/style_options.hpp"
#include "app/report/reference_output.hpp"
#include "app/report/reference_report.hpp"
#include "app/report/report_options.hpp"
#include "app/report/section_photos.hpp"

#include "render/report/document/pdf.hpp"
#include "storage/atomic/atomic_file.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

/// Rejects options that the reference report does not support.
void refuse_beside_references(const Arguments& arguments) {
    std::vector<std::string_view> refused{"--worst",
                                          "--photos",
                                          "--sections",
                                          "--section-length",
                                          "--homogeneous",
                                          "--exclude",
                                          "--exclude-radius",
                                          "--classes",
                                          "--compare-since",
                                          "--route",
                                          "--shortest",
                                          "--style",
                                          "--grey-below"};
    std::ranges::transform(selection_options, std::back_inserter(refused), &Option::name);
    for (const auto option : refused) {
        if (arguments.is_given(option)) {
            throw UsageError{fmt::format("{} and --against-reference cannot be combined", option)};
        }
    }
}

/// Rejects --language for rows, which are always in English.
void refuse_for_programs(const Arguments& arguments) {
    if (arguments.is_given("--language")) {
        throw UsageError{"with --against-reference, --language requires -o FILE.html or .pdf"};
    }
}

/// Output of --against-reference: a page, or rows in a file or on standard output.
struct ReferenceOutput {
    std::optional<std::filesystem::path> page;
    std::optional<std::filesystem::path> rows;
    std::string format; ///< of the rows
    UnitSystem units;   ///< likewise; no preference: programs read the same for every user
};

ReferenceOutput parse_reference_output(const Arguments& arguments) {
    ReferenceOutput output{.page = {},
                           .rows = row_file_of(arguments, {".html", ".pdf"}),
                           .format = row_format_of(arguments),
                           .units = arguments.is_given("--units") ? parse_units(arguments)
                                                                  : UnitSystem::si};
    if (const auto format = arguments.value("--format"); format == "html" || format == "pdf") {
        throw UsageError{fmt::format("--against-reference has --format table, csv or json, and "
                                     "-o FILE.{}",
                                     *format)};
    }
    if (!output.rows && !is_to_standard_output(arguments)) {
        output.page = arguments.value("--output");
    }
    if (output.page && (arguments.value("--format") || arguments.flag("--json"))) {
        throw UsageError{fmt::format("-o {} is a page, which --format and --json do not concern",
                                     output.page->string())};
    }
    return output;
}

void write_rows(const ReferenceReport& report, const ReferenceOutput& to) {
    RowOutput output{to.rows};
    if (to.format == "table") {
        print_words(reference_text(report, to.units));
    } else {
        print(to.format == "json" ? reference_json(report, to.units)
                                  : reference_csv(report, to.units));
    }
    output.commit();
}

void write_page(const ReferenceReport& report,
                const std::filesystem::path& file,
                const PdfConfig& pdf) {
    AtomicFile page{file};
    page.write(file.extension() == ".pdf" ? pdf_of(reference_document(report), pdf)
                                          : reference_html(report));
    page.commit();
}

void report_against_reference(const Arguments& arguments, const Console& console) {
    refuse_beside_references(arguments);
    const auto output = parse_reference_output(arguments);
    const auto pdf = parse_paper(arguments, output.page.value_or("").extension().string());
    if (!output.page) {
        refuse_for_programs(arguments);
    }
    const auto file = file_or_server(arguments);
    const auto wording =
        output.page ? wording_of(parse_look(arguments, file, console)) : Localisation{};
    for (const auto& written : {output.page, output.rows}) {
        if (written) {
            refuse_to_replace(*written, {file});
        }
    }
    const auto store = opened_reader(file, console);
    warn_of_waiting(store, file, console);
    tell_publication(store, console);
    const auto report = reference_report(
        store, arguments.value("--title").value_or(wording("reference.title")), wording);
    store.expect_in_place();
    output.page ? write_page(report, *output.page, pdf) : write_rows(report, output);
}

/// Rejects options of rows, which only --against-reference prints.
void refuse_rows(const Arguments& arguments) {
    const auto format = arguments.value("--format");
    if (arguments.value("--json") || (format && format != "html" && format != "pdf")) {
        throw UsageError{fmt::format("{} requires --against-reference",
                                     format ? "--format " + *format : std::string{"--json"})};
    }
}

/// Adds the photos of a folder to a report, and tells of those that it does not show.
void put_photos(const std::filesystem::path& folder, Report& report, const Console& console) {
    constexpr std::size_t max_lines = 20;
    const auto counts = add_photos(folder, report, console.progress("reading photos"));
    for (const auto& line : counts.skipped | std::views::take(max_lines)) {
        console.warn("skipped: " + printable_name(line));
    }
    if (counts.skipped.size() > max_lines) {
        console.warn(fmt::format("skipped: {} more files", counts.skipped.size() - max_lines));
    }
    console.say(photo_words(counts));
    if (counts.shown > 0) {
        console.say("photos may show people and number plates; look at them before you publish");
    }
}

void run_report(const Arguments& arguments, const Console& console) {
    if (arguments.flag("--against-reference")) {
        report_against_reference(arguments, console);
        return;
    }
    refuse_rows(arguments);
    auto options = parse_report(arguments, console);
    const auto store = opened_reader(options.store, console);
    auto inputs = files_of_filter(arguments);
    inputs.push_back(options.store);
    const bool to_standard_output = is_to_standard_output(arguments);
    if (!to_standard_output) {
        refuse_to_replace(options.output, inputs);
    }
    complete_filter(options.report.filter, store);
    warn_of_waiting(store, options.store, console);
    warn_of_empty_map(store, console);
    tell_publication(store, console);
    if (options.report.style.classes == nullptr) {
        options.report.style.classes = class_table(store.settings().class_table);
    }
    warn_of_look(options.report.style, console);
    options.report.events = can_show_events(store, options.report.filter, console);
    auto report = report_of(store, options.report, console.progress("drawing maps"));
    if (options.photos) {
        put_photos(*options.photos, report, console);
    }
    const auto document = report_document(report);
    const auto bytes = options.report.pictures == PictureUse::paper ? pdf_of(document, options.pdf)
                                                                    : html_of(document);
    store.expect_in_place();
    if (to_standard_output) {
        print(bytes);
    } else {
        AtomicFile file{options.output};
        file.write(bytes);
        file.commit();
    }
    console.say(fmt::format("{}: {:.1f} MB",
                            to_standard_output ? "standard output" : options.output.string(),
                            static_cast<double>(bytes.size()) / 1e6));
}

constexpr std::array operands{source_operand};
constexpr std::array output_options{
    Option{"-o,--output", "FILE", "The report, an .html or .pdf file; - for standard output."},
    Option{"--against-reference",
           "",
           "Compare cars with reference surveys: -o FILE.html, .pdf, .csv or .json, or a table."},
    one_of("table|csv|json|html|pdf",
           {"--format",
            "NAME",
            "Of --against-reference: table, csv or json; of -o -: html or pdf.",
            "table"}),
    json_option,
    Option{"--title", "TEXT", "Title of the report.", "Road roughness"},
    Option{"--compare-since", "DATE", "Report changes since this day: 2026-03-01 or 2026-03."}};
constexpr std::array page_options{
    preferred_units_option,
    preference(in_group("appearance",
                        {"--language",
                         "CODE",
                         "en, de, hu or another catalogue: a code of share/macadam/languages, or "
                         "the path of a .po file.",
                         "en"})),
    preference(one_of(
        "A4|letter",
        in_group("appearance", {"--paper", "SIZE", "Paper size of a .pdf: A4 or letter.", "A4"}))),
    Option{"--worst", "N", "Number of worst sections to list, each with a map.", "20"},
    Option{"--photos",
           "FOLDER",
           "Show its JPEG photos within 30 m, by EXIF position. They may show people: look before "
           "you publish."},
    in_group("sections",
             {"--route",
              "LAT,LON LAT,LON",
              "Strip chart along the fastest route by car between two points; --way charts a way.",
              "",
              true}),
    in_group("sections", {"--shortest", "", "With --route: the shortest route instead."}),
    sections_option,
    section_length_option,
    homogeneous_option,
    exclude_option,
    exclude_radius_option,
    preference(one_of(
        "fhwa|five",
        in_group("appearance",
                 {"--classes", "NAME", "fhwa (good, fair, poor) or five.", "as in the database"}))),
    style_option,
    grey_below_option,
    preference(in_group(
        "appearance",
        {"--left-hand", "", "Traffic keeps left: maps draw each direction on the left side."}))};
constexpr auto options = joined(output_options, selection_options, page_options);

} // namespace

const Command report_command{
    .name = "report",
    .summary = "Create a condition report: condition, worst sections, coverage, data",
    .about = "Writes one self-contained HTML file that opens in any browser, also on a phone; or a "
             "PDF for printing.\nThe same database gives the same bytes. Options that select "
             "segments or passes limit the report to these.",
    .example =
        "  macadam report roads.gpkg -o report.html --title \"Spring survey 2026\"\n"
        "  macadam report roads.gpkg -o report.pdf --compare-since 2026-04-01 --language de\n"
        "  macadam report roads.gpkg -o report.html --worst 50 --classes five\n"
        "  macadam report roads.gpkg -o street.html --way 24935371\n"
        "  macadam report roads.gpkg --against-reference -o reference.html",
    .operands = operands,
    .options = options,
    .run = run_report};

} // namespace macadam
