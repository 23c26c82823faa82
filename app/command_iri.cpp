#include "app/commands.hpp"
#include "app/iri_output.hpp"
#include "app/output_guard.hpp"

#include "estimator/common/error.hpp"
#include "estimator/localised_roughness.hpp"
#include "storage/erd_writer.hpp"

#include <fmt/format.h>

#include <array>

namespace macadam {
namespace {

struct IriOptions {
    IriQuestion question;
    std::optional<double> length_m; ///< nothing: one value for the whole
    std::optional<double> base_m;   ///< of a moving mean instead
    std::optional<double> threshold;
    std::optional<std::filesystem::path> output;
    IriWords words;
};

std::optional<double> length_in(const Arguments& arguments, std::string_view name) {
    const auto length_m = arguments.number(name);
    if (length_m && !(*length_m > 0)) {
        throw UsageError{fmt::format("{} is {}, expected a length over 0 m", name, *length_m)};
    }
    return length_m;
}

/// --continuous stands alone or with the base.
std::optional<double> base_in(const Arguments& arguments) {
    const auto word = arguments.value("--continuous");
    return word && word->empty() ? std::optional{localised_base_m}
                                 : length_in(arguments, "--continuous");
}

IriOptions parse_iri(const Arguments& arguments) {
    constexpr std::array<std::string_view, 2> units{"mm/m", "in/mi"};
    IriOptions options{.question = {.profile = arguments.operand("PROFILE"),
                                    .step_m = length_in(arguments, "--step"),
                                    .from_m = arguments.number("--from"),
                                    .to_m = arguments.number("--to"),
                                    .envelope = !arguments.flag("--no-envelope")},
                       .length_m = length_in(arguments, "--length"),
                       .base_m = base_in(arguments),
                       .threshold = arguments.number("--threshold"),
                       .output = arguments.value("--output"),
                       .words = {.in_per_mi = arguments.choice("--unit", units) == "in/mi",
                                 .json = arguments.flag("--json")}};
    if (options.threshold && !options.base_m) {
        throw UsageError{"--threshold is of a moving mean, expected --continuous beside it"};
    }
    if (options.length_m && options.base_m) {
        throw UsageError{"--length and --continuous are two reports, expected one of them"};
    }
    if (options.output && options.output->extension() != ".erd") {
        throw UsageError{
            fmt::format("-o is '{}', expected a file in .erd", options.output->string())};
    }
    return options;
}

void write_as_erd(const IriQuestion& question, const std::filesystem::path& output) {
    refuse_to_replace(output, {question.profile});
    auto profile = read_profile(question.profile, question.step_m);
    if (!profile.even_step_m) {
        throw InputError{fmt::format("{}: has uneven stations, an ERD file has even ones",
                                     question.profile.string())};
    }
    ErdProfile erd{.title = question.profile.stem().string(),
                   .start_m = profile.station_m.front(),
                   .step_m = *profile.even_step_m,
                   .channels = {}};
    for (auto& track : profile.tracks) {
        erd.channels.push_back({track.name, std::move(track.elevation_m)});
    }
    write_erd(output, erd);
}

void run_iri(const Arguments& arguments, const Console&) {
    const auto options = parse_iri(arguments);
    if (options.output) {
        write_as_erd(options.question, *options.output);
    }
    if (options.base_m) {
        print_moving_iri(options.question, *options.base_m, options.threshold, options.words);
    } else {
        print(text_of(iri_of_pieces(options.question, options.length_m), options.words));
    }
}

constexpr std::array operands{
    Operand{"PROFILE",
            "Elevations of wheel tracks: .csv with a header, .txt without one, .erd "
            "(UMTRI ERD 2.00) or .pro (TxDOT)."}};

constexpr std::array options{
    Option{"--step",
           "METRES",
           "From point to point. A .csv or .txt then has no stations: all columns are tracks."},
    Option{"--from", "METRES", "Station at which the reported part begins.", "the first"},
    Option{"--to", "METRES", "Station at which it ends.", "the last"},
    Option{"--length", "METRES", "Report pieces of this length.", "one for the whole"},
    Option{"--continuous",
           "[METRES]",
           "Report the mean over a base of this length that moves along the profile.",
           "7.62 (25 ft)"},
    Option{"--threshold",
           "IRI",
           "With --continuous: list the places where the moving mean is above this."},
    Option{"--unit", "UNIT", "mm/m (the same as m/km) or in/mi.", "mm/m"},
    Option{"--no-envelope", "", "The profile is already smoothed over the tyre's 250 mm contact."},
    Option{"-o,--output", "FILE.erd", "Write the whole profile as ERD 2.00, too."},
    Option{"--json", "", "One JSON object instead of CSV."}};

} // namespace

const Command iri_command{
    .name = "iri",
    .summary = "Reference IRI of a measured profile, by ASTM E1926",
    .about = "The golden car runs once through the whole profile; pieces are cut from its response "
             "afterwards, so\n"
             "their borders do not disturb it. Even stations are taken as they are, never "
             "resampled; uneven ones\n"
             "are solved exactly. Tracks named left and right also give MRI (the mean of the two "
             "IRI) and HRI (the\n"
             "IRI of the mean profile). lead_in marks what begins within 60 m of the profile's "
             "start, where the car's\n"
             "start may still show. With --from, what lies before serves as lead-in; where that "
             "is less than 11 m\n"
             "the car starts there.",
    .example = "  macadam iri profile.csv --length 100          station_m,left_m,right_m\n"
               "  macadam iri run1.erd --length 160.9344 --unit in/mi --json\n"
               "  macadam iri run1.pro --continuous --threshold 160 --unit in/mi",
    .operands = operands,
    .options = options,
    .run = run_iri};

} // namespace macadam
