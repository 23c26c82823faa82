#include "app/report/report_options.hpp"

#include "app/cli/row_output.hpp"
#include "app/database/period_options.hpp"
#include "app/database/selection.hpp"
#include "app/database/server_store.hpp"
#include "app/query/section_options.hpp"
#include "app/render/style_options.hpp"
#include "app/report/section_photos.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr std::int64_t max_stretches = 200; // each has maps of about 100 kB

std::size_t parse_worst(const Arguments& arguments) {
    const auto worst =
        arguments.integer("--worst").value_or(static_cast<std::int64_t>(ReportConfig{}.worst));
    if (worst < 0 || worst > max_stretches) {
        throw UsageError{fmt::format("--worst is {}, expected 0 to {}", worst, max_stretches)};
    }
    return static_cast<std::size_t>(worst);
}

MapStyle parse_style(const Arguments& arguments, const MapLook& look) {
    auto style = style_of(look);
    style.min_passes = grey_below(arguments).value_or(style.min_passes);
    style.left_hand_traffic = arguments.flag("--left-hand");
    return style;
}

/// Returns the language of a code, or of a catalogue by its path.
const Language& language_named(const std::string& name) {
    if (const auto* const found = language(name)) {
        return *found;
    }
    if (std::filesystem::path{name}.extension() == ".po") {
        return language_from(name);
    }
    std::vector<std::string> codes;
    for (const auto* const each : languages()) {
        codes.push_back(each->code);
    }
    throw UsageError{fmt::format(
        "--language is '{}', expected {} or the path of a .po file", name, fmt::join(codes, ", "))};
}

/// Returns the name of the page: of -o, or for standard output one with the suffix of --format.
std::optional<std::string> page_of(const Arguments& arguments) {
    const auto output = arguments.value("--output");
    const auto format = arguments.value("--format");
    const bool is_page = format == "html" || format == "pdf";
    if (output != standard_output) {
        if (is_page) {
            throw UsageError{fmt::format(
                "--format {} is for -o -; the name of a file tells its format", *format)};
        }
        return output;
    }
    return "report." + (is_page ? *format : std::string{"html"});
}

/// Returns the road of the strip chart, of --route or --way.
std::optional<StripRoad> parse_strip(const Arguments& arguments) {
    StripRoad road;
    road.route = parse_route(arguments);
    road.best =
        arguments.flag("--shortest") ? RouteConfig::Best::shortest : RouteConfig::Best::quickest;
    road.way_id = arguments.integer("--way");
    if (arguments.flag("--shortest") && !road.route) {
        throw UsageError{"--shortest requires --route LAT,LON LAT,LON"};
    }
    if (road.route && road.way_id) {
        throw UsageError{"--route and --way cannot be combined, expected one of them"};
    }
    return road.route || road.way_id ? std::optional{road} : std::nullopt;
}

} // namespace

Localisation wording_of(const ChosenLook& chosen) {
    Localisation wording;
    if (chosen.language) {
        wording.language = &language_named(*chosen.language);
    }
    wording.unit = chosen.look.unit == "in/mi" ? IriUnit::in_per_mi : IriUnit::mm_per_m;
    return wording;
}

PdfConfig parse_paper(const Arguments& arguments, std::string_view ending) {
    PdfConfig config;
    if (ending != ".pdf" && arguments.is_given("--paper")) {
        throw UsageError{"--paper requires -o FILE.pdf"};
    }
    if (arguments.choice("--paper") == "letter") {
        config.paper = us_letter;
    }
    return config;
}

bool is_to_standard_output(const Arguments& arguments) {
    return arguments.value("--output") == standard_output;
}

ReportOptions parse_report(const Arguments& arguments, const Console& console) {
    const auto output = page_of(arguments);
    const auto ending = std::filesystem::path{output.value_or("")}.extension().string();
    if (ending != ".html" && ending != ".pdf") {
        throw UsageError{
            output ? fmt::format("-o is '{}', expected a name that ends in .html or .pdf", *output)
                   : std::string{"-o report.html is missing"}};
    }
    const auto store = file_or_server(arguments);
    const auto look = parse_look(arguments, store, console);
    const auto wording = wording_of(look);
    auto sections = parse_sections(arguments, false);
    auto filter = parse_filter(arguments);
    if (sections) {
        expect_whole_sections(filter);
    }
    const auto since_ms = parse_begin(arguments, "--compare-since");
    if (since_ms && arguments.is_given("--class")) { // the class may be what changed
        throw UsageError{"--compare-since and --class cannot be combined"};
    }
    // One after the other: GCC 12 destroys a nested aggregate twice where a later member's
    // initializer throws.
    const auto pdf = parse_paper(arguments, ending);
    const auto strip = parse_strip(arguments);
    ReportConfig report{.title = arguments.value("--title").value_or(wording("title")),
                        .worst = parse_worst(arguments),
                        .sections = std::move(sections),
                        .strip = strip,
                        .filter = std::move(filter),
                        .selection = text_of_filter(arguments),
                        .since_ms = since_ms,
                        .wording = wording,
                        .pictures = ending == ".pdf" ? PictureUse::paper : PictureUse::screen,
                        .style = parse_style(arguments, look.look)};
    const auto photos = arguments.value("--photos");
    if (photos) {
        expect_photo_folder(*photos);
    }
    return {.store = store,
            .output = *output,
            .report = std::move(report),
            .pdf = pdf,
            .photos = photos};
}

} // namespace macadam
