#include "app/pipeline/estimation_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace macadam {
namespace {

constexpr double min_rate_hz = 40;
constexpr double max_rate_hz = 2000;

constexpr double smoother_samples_a_metre = 2.6; // waves of 1 m, with little effect on IRI

constexpr std::pair<std::string_view, bool SensorSet::*> sensor_names[] = {
    {"vertical", &SensorSet::vertical},
    {"lateral", &SensorSet::lateral},
    {"roll", &SensorSet::roll},
    {"pitch", &SensorSet::pitch},
    {"yaw", &SensorSet::yaw},
};

/// Parses a list of sensors such as "vertical,pitch".
SensorSet sensors_named(const std::string& list) {
    SensorSet sensors;
    std::size_t begin = 0;
    while (begin <= list.size()) {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        const auto word = std::string_view{list}.substr(begin, end - begin);
        const auto* const known = std::ranges::find(
            sensor_names, word, &std::pair<std::string_view, bool SensorSet::*>::first);
        if (known == std::end(sensor_names)) {
            throw UsageError{fmt::format("--channels names '{}', expected automatic, both, or some "
                                         "of vertical,lateral,roll,pitch,yaw",
                                         word)};
        }
        sensors.*(known->second) = true;
        begin = end + 1;
    }
    return sensors;
}

void choose_channels(EstimatorConfig& estimator, const std::string& list) {
    if (list == "automatic") {
        return;
    }
    const auto sensors =
        list == "both" ? SensorSet{.vertical = true, .lateral = true} : sensors_named(list);
    if (!sensors.roll && !sensors.pitch && !sensors.yaw) {
        estimator.channels = !sensors.lateral    ? Channels::vertical
                             : !sensors.vertical ? Channels::lateral
                                                 : Channels::both;
    } else if (estimator.method == Method::kf) {
        throw UsageError{fmt::format(
            "--channels is '{}', but --method kf supports vertical and lateral only", list)};
    } else {
        estimator.sensors = sensors;
    }
}

} // namespace

PipelineConfig pipeline_config_of(const Arguments& arguments) {
    PipelineConfig config;
    const bool smoother = arguments.choice("--method") != "kf";
    config.estimator.method = smoother ? Method::smoother : Method::kf;
    config.stretch.samples_a_metre = smoother ? smoother_samples_a_metre : 0;
    choose_channels(config.estimator, arguments.value("--channels").value_or("automatic"));
    config.estimator.filters = !arguments.flag("--no-filters");
    if (const auto rate_hz = arguments.number("--rate")) {
        if (!(*rate_hz >= min_rate_hz && *rate_hz <= max_rate_hz)) {
            throw UsageError{fmt::format(
                "--rate is {}, expected {} to {} Hz", *rate_hz, min_rate_hz, max_rate_hz)};
        }
        config.stretch.rate_hz = *rate_hz;
    }
    return config;
}

} // namespace macadam
