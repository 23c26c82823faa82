#include "app/cli/row_writer.hpp"
#include "app/profile/identify_output.hpp"
#include "app/profile/spectra_figure.hpp"
#include "estimator/identification/car_modes.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

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

std::string misfit_text(std::string_view name, const ChannelSpectra& spectra) {
    return fmt::format("{} spectra differ by {:.1f} % (rms), {:.1f} % before the fit\n",
                       name,
                       100 * spectra.misfit_after,
                       100 * spectra.misfit_before);
}

std::string table_of(const SpectrumFit& fit,
                     const ProfileResponse& ride,
                     const ProfilePosition& place,
                     const Vehicle& vehicle) {
    auto text = fmt::format("{}\ncompared: stations {:.1f} to {:.1f} m, {:.0f} s\n\n",
                            position_text(place),
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

std::string csv_of(const SpectrumFit& fit) {
    const auto decimal = [](double value, int decimals) {
        return fmt::format("{:.{}f}", value, decimals + 1);
    };
    const Columns<Row> columns{
        {"parameter", as::text, [](auto& r) { return r.name; }},
        {"start", as::raw, [&](auto& r) { return decimal(r.start, r.decimals); }},
        {"found", as::raw, [&](auto& r) { return decimal(r.found, r.decimals); }},
        {"relative_sd", as::real(4), [&](auto& r) {
             return fit.relative_sd.at(std::string{r.name});
         }}};
    return rows_text(columns, rows_of(fit), "csv");
}

std::string json_of(const SpectrumFit& fit,
                    const ProfileResponse& ride,
                    const ProfilePosition& place,
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
        .add("method", "spectrum")
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

std::string figure_of(const SpectrumFit& fit) {
    std::vector<ChartPanel> panels{
        spectra_panel("Vertical acceleration of the body", "m/s²", fit.vertical)};
    if (fit.lateral) {
        panels.push_back(spectra_panel("Lateral acceleration of the body", "m/s²", *fit.lateral));
    }
    return line_charts_svg(panels);
}

} // namespace

IdentifyOutput output_of(const SpectrumFit& fit,
                         const ProfileResponse& ride,
                         const ProfilePosition& place,
                         const Vehicle& identified) {
    return {.table = table_of(fit, ride, place, identified),
            .json = json_of(fit, ride, place, identified),
            .csv = csv_of(fit),
            .figure = figure_of(fit)};
}

} // namespace macadam
