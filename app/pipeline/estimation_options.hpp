#pragma once

#include "app/cli/arguments.hpp"
#include "app/pipeline/pipeline.hpp"

namespace macadam {

// Estimation options for trace and import.
inline constexpr Option method_option =
    rare(one_of("smoother|kf",
                in_group("estimation",
                         {"--method",
                          "NAME",
                          "Estimator: smoother (two axles, both tracks) or kf, "
                          "the published Kalman filter.",
                          "smoother"})));
inline constexpr Option channels_option = rare(in_group(
    "estimation",
    {"--channels",
     "LIST",
     "Sensors: any of vertical,lateral (acceleration),roll,pitch,yaw (rate); both; or automatic.",
     "automatic"}));
inline constexpr Option no_filters_option = rare(in_group(
    "estimation",
    {"--no-filters", "", "Disable the method's own filters, for noise-free simulated logs."}));
inline constexpr Option rate_option = rare(in_group(
    "estimation",
    {"--rate", "HZ", "Sampling rate at which the method runs.", "the log's, at most 200"}));

/// Parses the options above.
/// \throws UsageError  for an invalid word or number.
PipelineConfig pipeline_config_of(const Arguments& arguments);

} // namespace macadam
