#include "app/cli/commands.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/cli/row_output.hpp"
#include "app/output/units_option.hpp"
#include "app/profile/iri_options.hpp"
#include "app/profile/iri_output.hpp"

#include "estimator/common/error.hpp"
#include "storage/profiles/erd_writer.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>

namespace macadam {
namespace {

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
    const bool as_erd = options.output && options.output->extension() == ".erd";
    if (as_erd) {
        write_as_erd(options.question, *options.output);
    } else if (options.output) {
        refuse_to_replace(*options.output, {options.question.profile});
    }
    RowOutput output{as_erd ? std::nullopt : options.output};
    if (options.base_m) {
        print_moving_iri(options.question, *options.base_m, options.threshold, options.words);
    } else {
        print(text_of(iri_of_pieces(options.question, options.length_m), options.words));
    }
    output.commit();
}

constexpr std::array operands{
    Operand{"PROFILE",
            "Elevations of wheel tracks: .csv with a header, .txt without one, .erd "
            "(UMTRI ERD 2.00) or .pro (TxDOT)."}};

constexpr std::array options{
    Option{"--step",
           "METRES",
           "Distance between points. A .csv or .txt file then has no stations: all columns are "
           "tracks."},
    instead_of("--from",
               {"--from-m", "METRES", "Station at which the report begins.", "the first"}),
    instead_of("--to", {"--to-m", "METRES", "Station at which the report ends.", "the last"}),
    Option{"--length", "METRES", "Report segments of this length.", "one segment"},
    Option{"--continuous",
           "[METRES]",
           "Report the moving mean over a base of this length.",
           "7.62 (25 ft)"},
    Option{"--threshold",
           "IRI",
           "With --continuous: list the locations where the moving mean exceeds this."},
    former_units_option, // no preference: scripts read the same for every user
    Option{"--no-envelope",
           "",
           "Skip the 250 mm moving average: the profile is already "
           "smoothed."},
    one_of("csv|json",
           {"--format", "NAME", "csv, or one JSON object.", "by the suffix of -o; otherwise csv"}),
    Option{"-o,--output",
           "FILE",
           "Write the values to a .csv or .json file; or, as .erd, also the whole profile as ERD "
           "2.00."},
    json_option};

} // namespace

const Command iri_command{
    .name = "iri",
    .summary = "Compute the reference IRI of a measured profile (ASTM E1926)",
    .about = "Simulates the golden car once over the whole profile and cuts its response into "
             "segments afterwards, so\n"
             "segment borders do not disturb it. Evenly spaced stations are never resampled; "
             "uneven ones are solved\n"
             "exactly. Tracks named left and right also give MRI (mean of the two IRI) and HRI "
             "(IRI of the mean\n"
             "profile). lead_in marks segments that begin within 60 m of the start of the "
             "profile, where the initial\n"
             "state of the car may still matter. With --from-m, the profile before it serves as "
             "lead-in; if that is\n"
             "shorter than 11 m, the simulation starts at --from-m.",
    .example = "  macadam iri profile.csv --length 100          station_m,left_m,right_m\n"
               "  macadam iri run1.erd --length 160.9344 --units us --json\n"
               "  macadam iri run1.pro --continuous --threshold 160 --units us",
    .operands = operands,
    .options = options,
    .run = run_iri};

} // namespace macadam
