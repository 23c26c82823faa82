#include "app/cli/commands.hpp"
#include "app/cli/overwrite_guard.hpp"
#include "app/pipeline/column_mapping_option.hpp"
#include "app/pipeline/single_trip.hpp"
#include "app/pipeline/vehicle_lookup.hpp"

#include "estimator/common/error.hpp"
#include "estimator/identification/car_modes.hpp"
#include "estimator/identification/profile_registration.hpp"
#include "estimator/identification/spectrum_fit.hpp"
#include "estimator/motion/make_odometer.hpp"
#include "estimator/motion/mounting.hpp"
#include "estimator/motion/stretch.hpp"
#include "render/report/document/line_chart.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/profiles/profile_reader.hpp"
#include "storage/settings/vehicle_writer.hpp"
#include "storage/text/json.hpp"
#include "storage/trips/trip_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr double sure_correlation = 0.5; // over 300 m; wrong positions stay below 0.45

struct IdentifyOptions {
    fs::path trip;
    fs::path profile;
    std::optional<double> at_m;
    std::optional<double> step_m;
    std::vector<fs::path> outputs;
    bool json;
};

IdentifyOptions parse_identify(const Arguments& arguments) {
    constexpr std::array<std::string_view, 1> methods{"spectrum"};
    arguments.choice("--method", methods);
    const auto profile = arguments.value("--profile");
    if (!profile) {
        throw UsageError{"--profile FILE is missing: the measured profile of the road"};
    }
    IdentifyOptions options{.trip = arguments.operand("TRIP"),
                            .profile = *profile,
                            .at_m = arguments.number("--at"),
                            .step_m = arguments.number("--step"),
                            .outputs = {},
                            .json = arguments.flag("--json")};
    for (const auto& output : arguments.values("--output")) {
        options.outputs.emplace_back(output);
        const auto kind = options.outputs.back().extension();
        if (kind != ".toml" && kind != ".svg") {
            throw UsageError{
                fmt::format("-o is '{}', expected a name that ends in .toml or .svg", output)};
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
    auto use = unused(trip);
    const StretchConfig config;
    const auto odometer = make_odometer(trip, OdometerConfig{}, use);
    const auto mounting = estimate_mounting(trip, odometer);
    std::vector<Stretch> stretches;
    for (const auto& span : find_stretches(trip, odometer, config, use, mounting.otherwise)) {
        stretches.push_back(make_stretch(trip, span, odometer, mounting, config));
    }
    return stretches;
}

/// Position of the trip on the profile, and its source.
struct Place {
    double at_m;
    std::optional<ProfileRegistration> found; ///< `std::nullopt`: given by the user
};

Place place_of(const std::vector<Stretch>& stretches,
               const RoadProfile& road,
               const Vehicle& vehicle,
               const IdentifyOptions& options) {
    if (options.at_m) {
        return {*options.at_m, {}};
    }
    const auto found = find_place(stretches, road, vehicle);
    if (!found) {
        throw InputError{fmt::format("{}: has less than 100 m of driving that could be located "
                                     "on {}, expected more, or --at METRE",
                                     options.trip.string(),
                                     options.profile.string())};
    }
    if (found->correlation < sure_correlation) {
        throw InputError{fmt::format("{}: cannot be located on {}: the best position has a "
                                     "correlation of {:.2f}, expected {:.2f}, or --at METRE",
                                     options.trip.string(),
                                     options.profile.string(),
                                     found->correlation,
                                     sure_correlation)};
    }
    return {found->at_m, found};
}

ProfileResponse longest_ride(const std::vector<Stretch>& stretches,
                             const RoadProfile& road,
                             const Place& place,
                             const IdentifyOptions& options) {
    std::optional<ProfileResponse> longest;
    for (const auto& stretch : stretches) {
        auto ride = simulate_response(stretch, road, place.at_m);
        if (ride && (!longest || ride->to_m - ride->from_m > longest->to_m - longest->from_m)) {
            longest = std::move(ride);
        }
    }
    if (!longest) {
        throw InputError{fmt::format("{}: has no driving on {}, whose stations go from {:.1f} to "
                                     "{:.1f} m, with its start at {:.1f} m",
                                     options.trip.string(),
                                     options.profile.string(),
                                     road.station_m.front(),
                                     road.station_m.back(),
                                     place.at_m)};
    }
    return *std::move(longest);
}

struct Row {
    std::string_view name;
    double start;
    double found;
    int decimals;
};

std::vector<Row> rows_of(const SpectrumFit& fit) {
    const auto& [start, found] = std::pair{fit.start, fit.found};
    std::vector<Row> rows{{"ks_n_per_m", start.ks_n_per_m, found.ks_n_per_m, 0},
                          {"cs_ns_per_m", start.cs_ns_per_m, found.cs_ns_per_m, 0},
                          {"kt_n_per_m", start.kt_n_per_m, found.kt_n_per_m, 0}};
    if (fit.lateral) {
        rows.push_back({"is_kgm2", start.is_kgm2, found.is_kgm2, 0});
    }
    rows.push_back({"gain", 1, fit.gain, 3});
    return rows;
}

/// Explains a gain in plain words.
std::string meaning_of(double gain, const Vehicle& vehicle) {
    constexpr double one_axle = 0.93; // above it fit errors hide the wheelbase
    constexpr double comb_low = 0.6;
    if (gain >= one_axle) {
        return fmt::format("gain {:.2f}: the sensor responds about as a car with one axle "
                           "would on this road.",
                           gain);
    }
    if (gain < comb_low) {
        return fmt::format(
            "gain {:.2f}: lower than two axles can explain (0.71). Check that the profile is "
            "of this road and in\nmetres, and that the sensor's scale is right.",
            gain);
    }
    return fmt::format(
        "gain {:.2f}: the response is {:.2f} of that of the same car with one axle. A car has "
        "two, and a sensor\n"
        "between them measures the mean of both: waves of 2, 2/3, 2/5, ... wheelbases cancel, "
        "long ones do not.\n"
        "The rms of this comb filter is 0.71, whatever the wheelbase. The gain therefore "
        "reflects the wheelbase,\n"
        "not a modern suspension; it removes the bias of a one-axle method, but not the "
        "scatter{}.",
        gain,
        gain,
        vehicle.axles ? ""
                      : ". Give [axles] in the vehicle file for a method that models both "
                        "axles");
}

std::string place_text(const Place& place) {
    if (!place.found) {
        return fmt::format("travel 0 is at station {:.2f} m (as given)", place.at_m);
    }
    return fmt::format("travel 0 is at station {:.2f} m (located: the correlation of estimated "
                       "and measured profile is {:.2f} over {:.0f} m)",
                       place.at_m,
                       place.found->correlation,
                       place.found->compared_m);
}

std::string misfit_text(std::string_view name, const ChannelSpectra& spectra) {
    return fmt::format("{} spectra differ by {:.1f} % (rms), {:.1f} % before the fit\n",
                       name,
                       100 * spectra.misfit_after,
                       100 * spectra.misfit_before);
}

std::string table_of(const SpectrumFit& fit,
                     const ProfileResponse& ride,
                     const Place& place,
                     const Vehicle& vehicle) {
    auto text = fmt::format("{}\ncompared: stations {:.1f} to {:.1f} m, {:.0f} s\n\n",
                            place_text(place),
                            ride.from_m,
                            ride.to_m,
                            static_cast<double>(ride.vertical_mps2.size() - 1) * ride.step_s);
    text += fmt::format("{:<14}{:>10}{:>10}{:>8}\n", "", "start", "found", "sd");
    for (const auto& [name, start, found, decimals] : rows_of(fit)) {
        text += fmt::format("{:<14}{:>10.{}f}{:>10.{}f}{:>6.1f} %\n",
                            name,
                            start,
                            decimals,
                            found,
                            decimals,
                            100 * fit.relative_sd.at(std::string{name}));
    }
    text += fmt::format("not fitted: ms_kg {:g}, mu_kg {:g}, l_m {:g}{}\n"
                        "\n",
                        fit.found.ms_kg,
                        fit.found.mu_kg,
                        fit.found.l_m,
                        fit.lateral ? "" : fmt::format(", is_kgm2 {:g}", fit.found.is_kgm2));
    text += misfit_text("vertical", fit.vertical);
    if (fit.lateral) {
        text += misfit_text("lateral", *fit.lateral);
    }
    const auto modes = modes_of(fit.found);
    return text +
           fmt::format("body bounce at {:.2f} Hz with a damping ratio of {:.2f}, wheel hop at "
                       "{:.1f} Hz\n"
                       "{}\n",
                       modes.bounce_hz,
                       modes.bounce_damping,
                       modes.hop_hz,
                       meaning_of(fit.gain, vehicle));
}

std::string json_of(const SpectrumFit& fit,
                    const ProfileResponse& ride,
                    const Place& place,
                    const Vehicle& vehicle) {
    JsonObject parameters;
    for (const auto& [name, start, found, decimals] : rows_of(fit)) {
        JsonObject one;
        one.add("start", JsonNumber{start, decimals + 1})
            .add("found", JsonNumber{found, decimals + 1})
            .add("relative_sd", json_number(fit.relative_sd.at(std::string{name}), 4));
        parameters.add(name, JsonRaw{one.text()});
    }
    auto meaning = meaning_of(fit.gain, vehicle);
    std::ranges::replace(meaning, '\n', ' ');
    const auto modes = modes_of(fit.found);
    const auto correlation = place.found ? std::optional{place.found->correlation} : std::nullopt;
    const auto misfit = [](const ChannelSpectra& spectra) {
        return JsonNumber{spectra.misfit_after, 5};
    };
    JsonObject object;
    object.add("vehicle", vehicle.name)
        .add("at_m", JsonNumber{place.at_m, 2})
        .add("correlation", json_number(correlation, 3))
        .add("from_m", JsonNumber{ride.from_m, 2})
        .add("to_m", JsonNumber{ride.to_m, 2})
        .add("parameters", JsonRaw{parameters.text()})
        .add("misfit_vertical", misfit(fit.vertical))
        .add("misfit_lateral", fit.lateral ? JsonValue{misfit(*fit.lateral)} : JsonValue{nullptr})
        .add("bounce_hz", JsonNumber{modes.bounce_hz, 3})
        .add("bounce_damping", JsonNumber{modes.bounce_damping, 3})
        .add("hop_hz", JsonNumber{modes.hop_hz, 2})
        .add("meaning", std::move(meaning));
    return object.text() + "\n";
}

ChartPanel panel_of(const char* title, const ChannelSpectra& spectra) {
    using enum ChartLine::Look;
    const auto& hz = spectra.measured.hz;
    return {.title = title,
            .x_label = "frequency, Hz",
            .y_label = "amplitude, m/s² per √Hz",
            .lines = {{"model, before the fit", hz, spectra.before, faint},
                      {"measured", hz, spectra.measured.amplitude, solid},
                      {"model, fitted", hz, spectra.after, dashed}}};
}

std::string figure_of(const SpectrumFit& fit) {
    std::vector<ChartPanel> panels{panel_of("Vertical acceleration of the body", fit.vertical)};
    if (fit.lateral) {
        panels.push_back(panel_of("Lateral acceleration of the body", *fit.lateral));
    }
    return line_charts_svg(panels);
}

std::string vehicle_file_text(const Vehicle& vehicle, const IdentifyOptions& options) {
    return fmt::format("# Identified by 'macadam identify --method spectrum' from {} on {}.\n{}",
                       options.trip.filename().string(),
                       options.profile.filename().string(),
                       vehicle_text(vehicle));
}

void write_file(const fs::path& file, const std::string& text) {
    AtomicFile out{file};
    out.write(text);
    out.commit();
}

void run_identify(const Arguments& arguments, const Console& console) {
    const auto options = parse_identify(arguments);
    VehicleChoice vehicles{arguments};
    for (const auto& output : options.outputs) {
        refuse_to_replace(output, {options.trip, options.profile});
    }
    const auto road = road_of(read_profile(options.profile, options.step_m), options.profile);
    const auto source = one_trip(options.trip, mapping_of(arguments));
    const auto trip = read_trip(source, needs_of_trace(), console.progress("reading"));
    const auto chosen = vehicles(options.trip, trip.meta.vehicle_id);
    if (!chosen.warning.empty()) {
        console.warn(chosen.warning);
    }
    const auto stretches = with_trip_name(source.name(), [&] { return stretches_of(trip); });
    const auto place = place_of(stretches, road, chosen.vehicle, options);
    const auto ride = longest_ride(stretches, road, place, options);
    const auto fit = with_trip_name(source.name(), [&] {
        return fit_spectra(ride,
                           chosen.vehicle.half_car,
                           chosen.vehicle.imu.height_above_roll_axis_m,
                           SpectrumFitConfig{});
    });
    auto vehicle = identified(chosen.vehicle, fit);
    if (!trip.meta.vehicle_id.empty()) {
        vehicle.name = trip.meta.vehicle_id;
    }
    for (const auto& output : options.outputs) {
        write_file(output,
                   output.extension() == ".svg" ? figure_of(fit)
                                                : vehicle_file_text(vehicle, options));
    }
    print(options.json ? json_of(fit, ride, place, vehicle) : table_of(fit, ride, place, vehicle));
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
    Option{"--method", "spectrum", "Identification method: spectrum, as in the paper.", "spectrum"},
    vehicle_option,
    vehicles_option,
    mapping_option,
    Option{"--at",
           "METRES",
           "Station at which the trip starts (its travel 0).",
           "located by the profile"},
    Option{"-o,--output",
           "FILE",
           "The identified vehicle (.toml), or the spectra as a figure (.svg).",
           "",
           true},
    Option{"--json", "", "One JSON object instead of the table."}};

} // namespace

const Command identify_command{
    .name = "identify",
    .summary = "Identify a car's springs, damper, tyre and gain from a drive over a measured "
               "road",
    .about = "Drives a one-axle car model over the profile as the trip drove over the road, "
             "and fits its parameters so\n"
             "that the amplitude spectrum of its vibration matches the measured one from 0.5 "
             "to 15 Hz. Masses and\n"
             "width are taken from the vehicle; all other parameters start at the golden car. "
             "Vertical vibration gives\n"
             "ks, cs, kt and gain, lateral vibration is_kgm2.",
    .example = "  macadam identify drive.trip.csv --profile survey.csv --vehicle my_car.toml -o "
               "found.toml spectra.svg",
    .operands = operands,
    .options = options,
    .run = run_identify};

} // namespace macadam
