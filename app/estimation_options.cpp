#include "app/estimation_options.hpp"

#include <fmt/format.h>

#include <array>

namespace macadam {
namespace {

constexpr double least_rate_hz = 40;
constexpr double most_rate_hz = 2000;

constexpr double smoother_samples_a_metre = 2.6; // waves of 1 m, of which IRI has little left

Channels channels_named(const std::string& name) {
    if (name == "vertical") {
        return Channels::vertical;
    }
    if (name == "lateral") {
        return Channels::lateral;
    }
    return name == "both" ? Channels::both : Channels::automatic;
}

} // namespace

PipelineConfig pipeline_config_of(const Arguments& arguments) {
    constexpr std::array<std::string_view, 2> methods{"smoother", "kf"};
    constexpr std::array<std::string_view, 4> channels{"automatic", "vertical", "lateral", "both"};

    PipelineConfig config;
    const bool smoother = arguments.choice("--method", methods) != "kf";
    config.estimator.method = smoother ? Method::smoother : Method::kf;
    // Rates of turn say more of braking and of shaking mounts than of the road (docs/smoother.md).
    config.estimator.tracks = config.estimator.tracks && !smoother;
    config.stretch.samples_a_metre = smoother ? smoother_samples_a_metre : 0;
    config.estimator.channels = channels_named(arguments.choice("--channels", channels));
    config.estimator.filters = !arguments.flag("--no-filters");
    if (const auto rate_hz = arguments.number("--rate")) {
        if (!(*rate_hz >= least_rate_hz && *rate_hz <= most_rate_hz)) {
            throw UsageError{fmt::format(
                "--rate is {}, expected {} to {} Hz", *rate_hz, least_rate_hz, most_rate_hz)};
        }
        config.stretch.rate_hz = *rate_hz;
    }
    return config;
}

} // namespace macadam
