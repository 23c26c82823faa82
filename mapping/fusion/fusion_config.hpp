#pragma once

namespace macadam {

/// Model of how a road changes. Relative to its level where no unit is given.
struct ChangeModel {
    double slope_sd_per_year = 0.03; ///< steady trend, relative part
    double slope_sd_um_per_year = 100;
    double walk_sd_per_root_year = 0.007; ///< random walk about the trend
    double season_sd = 0.007;             ///< between winter and summer
    double min_step = 0.1;                ///< smaller steps are no resurfacing
    double min_step_um = 200;
    double step_nats = 9; ///< required gain in log-likelihood of a step; chance alone reaches it
                          ///< about once in 5,000 segments of 60 months
};

/// Model of outlying cars and passes.
struct TailModel {
    double dof = 4;        ///< of Student's t
    double scatter_sd = 0; ///< observed in the readings; replaces a larger sd of a car
};

/// Error budget of passes. The sd stated by a pass covers the errors of its car and the method;
/// passes differ by more, because no two drives are alike.
struct FusionConfig {
    double common_share = 0.5; ///< of the stated variance, common to all cars: same model, same
                               ///< road between the tracks (docs/method/fusion.md)
    double car_share = 0.5;    ///< of the stated variance, common to all passes of a car

    /// Limits of the common part; what is beyond them is the car's. A car of which little is known
    /// states much, but not all unknown cars are wrong alike (docs/method/fusion.md). Passes with
    /// lateral acceleration alone have no limit, because its ratio to the vertical one is common to
    /// all cars; nor have those of the published filter (FusionInput::by_filter).
    double max_common_relative_sd = 0.07;
    double max_common_sd_mm_per_m = 0.08;

    double trip_relative_sd = 0.02;    ///< common to all passes of a trip: load, tyres, weather
    double rest_relative_sd = 0.07746; ///< of each pass: wander, speed; 0.08 including trips
    double rest_sd_mm_per_m = 0.05;
    double anchor_relative_sd = 0; ///< common to all cars once calibrated
    TailModel tail{};
    ChangeModel change{};
};

/// Returns the largest variance common to all cars, um^2/m^2, of passes that have a limit.
inline double max_common_variance_um2(double level_um, const FusionConfig& config) {
    const double relative_um = config.max_common_relative_sd * level_um;
    const double absolute_um = 1000 * config.max_common_sd_mm_per_m;
    return relative_um * relative_um + absolute_um * absolute_um;
}

} // namespace macadam
