#include "app/cli/row_writer.hpp"
#include "app/profile/identify_output.hpp"
#include "app/profile/spectra_figure.hpp"
#include "estimator/identification/car_modes.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

struct ChannelWords {
    std::string_view key;
    std::string_view title;
    std::string_view unit;
};

/// Names by Channel.
constexpr ChannelWords channel_words[] = {{"vertical", "Vertical acceleration of the body", "m/s²"},
                                          {"lateral", "Lateral acceleration of the body", "m/s²"},
                                          {"roll_rate", "Roll rate of the body", "rad/s"},
                                          {"pitch_rate", "Pitch rate of the body", "rad/s"}};

const ChannelWords& words_of(Channel channel) {
    return channel_words[static_cast<std::size_t>(channel)];
}

/// Decimals that show a value to a thousandth of itself.
int decimals_of(double value) {
    return value >= 1000 ? 0 : value >= 100 ? 1 : value >= 10 ? 2 : 3;
}

std::string correlation_text(const LikelihoodFit& fit) {
    auto text = fmt::format("{:<22}", "correlation");
    for (std::size_t column = 0; column < fit.parameters.size(); ++column) {
        text += fmt::format("{:>6}", column + 1);
    }
    text += '\n';
    for (std::size_t row = 0; row < fit.parameters.size(); ++row) {
        text += fmt::format("{:>2} {:<19}", row + 1, fit.parameters[row].name);
        for (std::size_t column = 0; column <= row; ++column) {
            text += fmt::format(
                "{:>6.2f}",
                fit.correlation(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)));
        }
        text += '\n';
    }
    return text;
}

std::string table_of(const LikelihoodFit& fit, const ProfilePosition& place) {
    auto text = fmt::format("{}\ncompared: stations {:.1f} to {:.1f} m, {:.0f} s, corrected by "
                            "{:.2f} to {:.2f} m\n\n",
                            position_text(place),
                            fit.from_m,
                            fit.to_m,
                            fit.duration_s,
                            fit.min_shift_m,
                            fit.max_shift_m);
    text += fmt::format("{:<22}{:>10}{:>10}{:>10}{:>10}{:>10}\n"
                        "{:<22}{:>10}{:>10}{:>10}{:>10}{:>10}\n",
                        "",
                        "before",
                        "sd",
                        "found",
                        "sd",
                        "sd, if",
                        "",
                        "",
                        "",
                        "",
                        "",
                        "ms_kg is right");
    for (const auto& one : fit.parameters) {
        text += fmt::format("{:<22}{:>10.{}f}{:>8.1f} %{:>10.{}f}{:>8.1f} %{:>8.1f} %\n",
                            one.name,
                            one.start,
                            decimals_of(one.start),
                            100 * one.prior_sd,
                            one.found,
                            decimals_of(one.start),
                            100 * one.sd,
                            100 * one.sd_given_mass);
    }
    text += "\n" + correlation_text(fit) + "\n";
    for (const auto& [channel, spectra] : fit.channels) {
        text += fmt::format("{}: the model leaves {:.1f} % of the readings (rms), {:.1f} % before "
                            "the fit\n",
                            words_of(channel).title,
                            100 * spectra.misfit_after,
                            100 * spectra.misfit_before);
    }
    const auto modes = modes_of(fit.vehicle.half_car);
    return text + fmt::format("body bounce at {:.2f} Hz with a damping ratio of {:.2f}, wheel hop "
                              "at {:.1f} Hz\n",
                              modes.bounce_hz,
                              modes.bounce_damping,
                              modes.hop_hz);
}

JsonRaw parameters_json(const LikelihoodFit& fit) {
    JsonObject parameters;
    for (const auto& one : fit.parameters) {
        const int decimals = decimals_of(one.start) + 1;
        JsonObject object;
        object.add("start", JsonNumber{one.start, decimals})
            .add("found", JsonNumber{one.found, decimals})
            .add("relative_sd", JsonNumber{one.sd, 4})
            .add("relative_sd_given_mass", JsonNumber{one.sd_given_mass, 4})
            .add("prior_relative_sd", JsonNumber{one.prior_sd, 4});
        parameters.add(one.name, JsonRaw{object.text()});
    }
    return {parameters.text()};
}

JsonRaw correlation_json(const LikelihoodFit& fit) {
    JsonObject rows;
    for (std::size_t row = 0; row < fit.parameters.size(); ++row) {
        JsonObject object;
        for (std::size_t column = 0; column < fit.parameters.size(); ++column) {
            object.add(fit.parameters[column].name,
                       JsonNumber{fit.correlation(static_cast<Eigen::Index>(row),
                                                  static_cast<Eigen::Index>(column)),
                                  3});
        }
        rows.add(fit.parameters[row].name, JsonRaw{object.text()});
    }
    return {rows.text()};
}

/// Values have one decimal more than the table shows, as in JSON.
std::string csv_of(const LikelihoodFit& fit) {
    const auto decimal = [](double value, double start) {
        return fmt::format("{:.{}f}", value, decimals_of(start) + 1);
    };
    const Columns<FittedParameter> columns{
        {"parameter", as::text, [](auto& r) { return r.name; }},
        {"start", as::raw, [&](auto& r) { return decimal(r.start, r.start); }},
        {"found", as::raw, [&](auto& r) { return decimal(r.found, r.start); }},
        {"relative_sd", as::real(4), [](auto& r) { return r.sd; }},
        {"relative_sd_given_mass", as::real(4), [](auto& r) { return r.sd_given_mass; }},
        {"prior_relative_sd", as::real(4), [](auto& r) { return r.prior_sd; }}};
    return rows_text(columns, fit.parameters, "csv");
}

JsonValue misfit_of(const LikelihoodFit& fit, Channel channel) {
    for (const auto& one : fit.channels) {
        if (one.channel == channel) {
            return JsonNumber{one.spectra.misfit_after, 5};
        }
    }
    return nullptr;
}

std::string
json_of(const LikelihoodFit& fit, const ProfilePosition& place, const Vehicle& identified) {
    const auto modes = modes_of(fit.vehicle.half_car);
    const auto correlation = place.found ? std::optional{place.found->correlation} : std::nullopt;
    JsonObject object;
    object.add("vehicle", identified.name)
        .add("method", "likelihood")
        .add("at_m", JsonNumber{place.at_m, 2})
        .add("correlation", json_number(correlation, 3))
        .add("from_m", JsonNumber{fit.from_m, 2})
        .add("to_m", JsonNumber{fit.to_m, 2})
        .add("parameters", parameters_json(fit))
        .add("parameter_correlation", correlation_json(fit))
        .add("not_excited", JsonRaw{json_string_array(unexcited_parameters(fit))})
        .add("settled", fit.settled);
    for (const auto channel :
         {Channel::vertical, Channel::lateral, Channel::roll_rate, Channel::pitch_rate}) {
        object.add(fmt::format("misfit_{}", words_of(channel).key), misfit_of(fit, channel));
    }
    object.add("bounce_hz", JsonNumber{modes.bounce_hz, 3})
        .add("bounce_damping", JsonNumber{modes.bounce_damping, 3})
        .add("hop_hz", JsonNumber{modes.hop_hz, 2})
        .add("meaning",
             fmt::format("gain {:.2f}: measured = gain * modelled, of the accelerations of a car "
                         "with both axles.",
                         fit.vehicle.gain));
    return object.text() + "\n";
}

std::string figure_of(const LikelihoodFit& fit) {
    std::vector<ChartPanel> panels;
    for (const auto& [channel, spectra] : fit.channels) {
        const auto& words = words_of(channel);
        panels.push_back(spectra_panel(std::string{words.title}, std::string{words.unit}, spectra));
    }
    return line_charts_svg(panels);
}

} // namespace

IdentifyOutput
output_of(const LikelihoodFit& fit, const ProfilePosition& place, const Vehicle& identified) {
    return {.table = table_of(fit, place),
            .json = json_of(fit, place, identified),
            .csv = csv_of(fit),
            .figure = figure_of(fit)};
}

} // namespace macadam
