#pragma once

#include "app/cli/arguments.hpp"
#include "app/pipeline/pipeline.hpp"

namespace macadam {

// The options that steer the estimation, for the tables of trace and import.
inline constexpr Option method_option{"--method",
                                      "NAME",
                                      "Estimator: smoother (two axles, both tracks) or kf, "
                                      "the published Kalman filter.",
                                      "smoother"};
inline constexpr Option channels_option{
    "--channels",
    "LIST",
    "Sensors: any of vertical,lateral (acceleration),roll,pitch,yaw (rate); both; or automatic.",
    "automatic"};
inline constexpr Option no_filters_option{
    "--no-filters", "", "Disable the method's own filters, for noise-free simulated logs."};
inline constexpr Option rate_option{
    "--rate", "HZ", "Sampling rate at which the method runs.", "the log's, at most 200"};

/// \throws UsageError  for a word or a number that does not fit.
PipelineConfig pipeline_config_of(const Arguments& arguments);

} // namespace macadam
