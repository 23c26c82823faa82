#include "app/cli/commands.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/cli/row_output.hpp"
#include "app/pipeline/column_mapping_option.hpp"
#include "app/pipeline/single_trip.hpp"
#include "app/pipeline/vehicle_lookup.hpp"
#include "app/profile/identify_output.hpp"
#include "app/profile/locate_on_profile.hpp"

#include "estimator/common/error.hpp"
#include "estimator/motion/stretch.hpp"
#include "estimator/motion/trip_motion.hpp"
#include "estimator/smoother/response_inverse.hpp"
#include "estimator/vehicle/vehicle_prior.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/profiles/profile_reader.hpp"
#include "storage/settings/vehicle_writer.hpp"
#include "storage/trips/trip_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view likelihood = "likelihood";
constexpr std::string_view spectrum = "spectrum";

struct IdentifyOptions {
    fs::path trip;
    fs::path profile;
    std::optional<double> at_m;
    std::optional<double> step_m;
    std::vector<fs::path> outputs; ///< vehicle files and figures
    std::optional<fs::path> row_file;
    std::string format;
    std::string method;
    bool is_method_given;
};

IdentifyOptions parse_identify(const Arguments& arguments) {
    const auto profile = arguments.value("--profile");
    if (!profile) {
        throw UsageError{"--profile FILE is missing: the measured profile of the road"};
    }
    IdentifyOptions options{.trip = arguments.operand("TRIP"),
                            .profile = *profile,
                            .at_m = arguments.number("--at"),
                            .step_m = arguments.number("--step"),
                            .outputs = {},
                            .row_file = row_file_of(arguments, {".toml", ".svg"}),
                            .format = row_format_of(arguments),
                            .method = arguments.choice("--method"),
                            .is_method_given = arguments.value("--method").has_value()};
    for (const auto& output : arguments.values("--output")) {
        if (const fs::path file{output}; file != options.row_file) {
            options.outputs.push_back(file);
        }
    }
    return options;
}

/// Returns both tracks: those named left and right, or the only two, or the only one twice.
RoadProfile road_of(const MeasuredProfile& measured, const fs::path& file) {
    const auto named = [&](std::string_view name) {
        return std::ranges::find(measured.tracks, name, &MeasuredProfile::Track::name);
    };
    const auto left = named("left");
    const auto right = named("right");
    if (left != measured.tracks.end() && right != measured.tracks.end()) {
        return {measured.station_m, left->elevation_m, right->elevation_m};
    }
    if (measured.tracks.size() > 2) {
        throw InputError{
            fmt::format("{}: has {} tracks, none of them named left_m and right_m, expected these",
                        file.string(),
                        measured.tracks.size())};
    }
    return {measured.station_m,
            measured.tracks.front().elevation_m,
            measured.tracks.back().elevation_m};
}

std::vector<Stretch> stretches_of(const TripLog& trip) {
    const StretchConfig config; // the log's own rate, at most 200 Hz
    const auto motion = motion_of(trip);
    const auto found = find_stretches(trip, motion.odometer, config, motion.mounting.otherwise);
    std::vector<Stretch> stretches;
    for (const auto& span : found.spans) {
        stretches.push_back(make_stretch(trip, span, motion.odometer, motion.mounting, config));
    }
    return stretches;
}

/// Trip whose position on the measured road is known: the data of every fit.
struct LocatedTrip {
    std::string name;
    std::vector<Stretch> stretches;
    RoadProfile road;
    ProfilePosition place;
};

InputError nothing_on_profile(const LocatedTrip& trip, const IdentifyOptions& options) {
    return InputError{fmt::format("{}: has no driving on {}, whose stations go from {:.1f} to "
                                  "{:.1f} m, with its start at {:.1f} m",
                                  options.trip.string(),
                                  options.profile.string(),
                                  trip.road.station_m.front(),
                                  trip.road.station_m.back(),
                                  trip.place.at_m)};
}

/// Returns the car with the low-pass that `import` will assume, so that no damping stands in for
/// it; beyond 200 Hz it makes no difference.
Vehicle with_lowpass_of_log(const Vehicle& vehicle, std::span<const Stretch> stretches) {
    return stretches.empty() ? vehicle : with_usual_lowpass(vehicle, 1 / stretches.front().step_s);
}

/// Removes the sensor's own low-pass from the readings.
ProfileResponse without_lowpass(ProfileResponse ride, const ImuMount& imu) {
    if (imu.lowpass_hz < no_lowpass_hz) {
        for (auto* readings : {&ride.vertical_mps2, &ride.lateral_mps2}) {
            *readings = inverse_lowpass(*readings, ride.step_s, imu.lowpass_hz, imu.lowpass_order);
        }
    }
    return ride;
}

struct Identified {
    Vehicle vehicle;
    IdentifyOutput output;
    std::vector<std::string> warnings;
};

std::string name_of(const Vehicle& vehicle, const std::string& vehicle_id) {
    return vehicle_id.empty() ? vehicle.name : vehicle_id;
}

Identified identified_by_spectrum(const LocatedTrip& trip,
                                  const Vehicle& vehicle,
                                  const std::string& vehicle_id,
                                  const IdentifyOptions& options) {
    std::optional<ProfileResponse> longest;
    for (const auto& stretch : trip.stretches) {
        auto ride = simulate_response(stretch, trip.road, trip.place.at_m);
        if (ride && (!longest || ride->to_m - ride->from_m > longest->to_m - longest->from_m)) {
            longest = std::move(ride);
        }
    }
    if (!longest) {
        throw nothing_on_profile(trip, options);
    }
    longest = without_lowpass(std::move(*longest), vehicle.imu);
    const auto fit = with_trip_name(trip.name, [&] {
        return fit_spectra(
            *longest, vehicle.half_car, vehicle.imu.height_above_roll_axis_m, SpectrumFitConfig{});
    });
    auto found = identified(vehicle, fit);
    found.name = name_of(vehicle, vehicle_id);
    auto output = output_of(fit, *longest, trip.place, found);
    return {std::move(found), std::move(output), {}};
}

std::vector<std::string> warnings_of(const ProfileDrive& drive, const LikelihoodFit& fit) {
    std::vector<std::string> warnings;
    if (drive.left_out_m > 0) {
        warnings.push_back(fmt::format("the drive on the profile is {:.1f} km long: fitted to the "
                                       "{:.0f} km nearest its middle",
                                       (max_drive_m + drive.left_out_m) / 1000,
                                       max_drive_m / 1000));
    }
    if (!fit.settled) {
        warnings.emplace_back("the fit did not settle: do not rely on its values and standard "
                              "deviations; use a longer drive over a rougher road, or check the "
                              "masses and axles of the vehicle file, the profile and --at");
    }
    const auto not_excited = unexcited_parameters(fit);
    if (!not_excited.empty()) {
        warnings.push_back(fmt::format("the drive did not excite {}: mostly the values of the "
                                       "vehicle file",
                                       fmt::join(not_excited, ", ")));
    }
    return warnings;
}

Identified identified_by_likelihood(const LocatedTrip& trip,
                                    const Vehicle& vehicle,
                                    const std::string& vehicle_id,
                                    const IdentifyOptions& options) {
    std::optional<ProfileDrive> longest;
    for (const auto& stretch : trip.stretches) {
        auto drive = drive_on_profile(stretch, trip.road, vehicle, trip.place.at_m);
        if (drive && (!longest || drive->station_m.size() > longest->station_m.size())) {
            longest = std::move(drive);
        }
    }
    if (!longest) {
        throw nothing_on_profile(trip, options);
    }
    const auto fit = with_trip_name(
        trip.name, [&] { return fit_likelihood(*longest, vehicle, LikelihoodFitConfig{}); });
    auto found = fit.vehicle;
    found.name = name_of(vehicle, vehicle_id);
    auto output = output_of(fit, trip.place, found);
    return {std::move(found), std::move(output), warnings_of(*longest, fit)};
}

/// Selects the method. The likelihood needs both axles: without them and without --method, the
/// paper's method is used.
bool is_likelihood(const Vehicle& vehicle, const IdentifyOptions& options, const Console& console) {
    if (options.method == spectrum || vehicle.axles) {
        return options.method == likelihood;
    }
    if (options.is_method_given) {
        throw InputError{fmt::format("vehicle '{}' has no [axles], which --method likelihood "
                                     "needs: give wheelbase_m and cg_to_front_m, or use --method "
                                     "spectrum",
                                     vehicle.name)};
    }
    console.warn(fmt::format("vehicle '{}' has no [axles]: fitted with one axle, as by --method "
                             "spectrum; give wheelbase_m and cg_to_front_m for the likelihood fit",
                             vehicle.name));
    return false;
}

std::string
vehicle_file_text(const Vehicle& vehicle, bool by_likelihood, const IdentifyOptions& options) {
    return fmt::format("# Identified by 'macadam identify --method {}' from {} on {}.\n{}{}",
                       by_likelihood ? likelihood : spectrum,
                       options.trip.filename().string(),
                       options.profile.filename().string(),
                       by_likelihood ? "# The uncertainties hold if ms_kg is right: roughness "
                                       "depends only on ratios to it.\n"
                                     : "",
                       vehicle_text(vehicle));
}

void write_file(const fs::path& file, const std::string& text) {
    AtomicFile out{file};
    out.write(text);
    out.commit();
}

void write_rows(const IdentifyOutput& result, const IdentifyOptions& options) {
    RowOutput output{options.row_file};
    print(options.format == "json"  ? result.json
          : options.format == "csv" ? result.csv
                                    : result.table);
    output.commit();
}

void run_identify(const Arguments& arguments, const Console& console) {
    const auto options = parse_identify(arguments);
    VehicleChoice vehicles{arguments};
    for (const auto& output : options.outputs) {
        refuse_to_replace(output, {options.trip, options.profile});
    }
    if (options.row_file) {
        refuse_to_replace(*options.row_file, {options.trip, options.profile});
    }
    const auto road = road_of(read_profile(options.profile, options.step_m), options.profile);
    const auto source = one_trip(options.trip, mapping_of(arguments));
    auto trip = read_trip(source, needs_of_trace(), console.progress("reading"));
    with_trip_name(source.name(), [&] { vehicles.name_car(trip.meta); });
    const auto chosen = vehicles(options.trip, trip.meta);
    if (!chosen.warning.empty()) {
        console.warn(chosen.warning);
    }
    auto stretches = with_trip_name(source.name(), [&] { return stretches_of(trip); });
    const auto vehicle = with_lowpass_of_log(chosen.vehicle, stretches);
    const auto place =
        locate_on_profile(stretches, road, vehicle, options.at_m, options.trip, options.profile);
    const LocatedTrip located{source.name(), std::move(stretches), road, place};
    const bool by_likelihood = is_likelihood(vehicle, options, console);
    const auto identify = by_likelihood ? identified_by_likelihood : identified_by_spectrum;
    const auto result = identify(located, vehicle, trip.meta.vehicle_id, options);
    for (const auto& warning : result.warnings) {
        console.warn(warning);
    }
    for (const auto& output : options.outputs) {
        write_file(output,
                   output.extension() == ".svg"
                       ? result.output.figure
                       : vehicle_file_text(result.vehicle, by_likelihood, options));
    }
    write_rows(result.output, options);
}

constexpr std::array operands{
    Operand{"TRIP",
            "One trip log over the measured road, in the direction of increasing "
            "stations."}};
constexpr std::array options{
    Option{"--profile",
           "FILE",
           "Elevations of the wheel tracks, in any format that 'macadam iri' "
           "reads."},
    Option{"--step", "METRES", "Distance between rows, for a profile without stations."},
    one_of("likelihood|spectrum",
           {"--method",
            "METHOD",
            "likelihood: both axles, all sensors; spectrum: one axle, as in the paper.",
            "likelihood"}),
    vehicle_option,
    vehicles_option,
    vehicle_id_option,
    mapping_option,
    Option{"--at",
           "METRES",
           "Station at which the trip starts (its travel 0).",
           "located by the profile"},
    Option{"-o,--output",
           "FILE",
           "The identified vehicle (.toml), the spectra as a figure (.svg), or the table (.csv, "
           ".json).",
           "",
           true},
    one_of("table|csv|json",
           {"--format", "NAME", "table, csv (a row for each parameter) or json.", "table"}),
    json_option};

} // namespace

const Command identify_command{
    .name = "identify",
    .summary = "Identify a car's springs, damper, tyre and gain from a drive over a measured "
               "road",
    .about = "Drives a car model over the profile as the trip drove over the road, and finds the "
             "parameters that explain the\n"
             "readings best within the uncertainties of the vehicle file, each with its standard "
             "deviation. The vehicle\n"
             "needs [axles]; without them, or with --method spectrum, a one-axle model is fitted "
             "so that the amplitude\n"
             "spectra match from 0.5 to 15 Hz.",
    .example = "  macadam identify drive.trip.csv --profile survey.csv --vehicle my_car.toml -o "
               "found.toml spectra.svg",
    .operands = operands,
    .options = options,
    .run = run_identify};

} // namespace macadam
