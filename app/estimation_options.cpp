#include "app/estimation_options.hpp"

#include <fmt/format.h>

#include <array>

namespace macadam {
namespace {

constexpr double least_rate_hz = 40;
constexpr double most_rate_hz = 2000;

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
    constexpr std::array<std::string_view, 1> methods{"kf"};
    constexpr std::array<std::string_view, 4> channels{"automatic", "vertical", "lateral", "both"};

    PipelineConfig config;
    arguments.choice("--method", methods);
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
