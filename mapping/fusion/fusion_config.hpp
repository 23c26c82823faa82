#pragma once

namespace macadam {

/// How a road changes. Relative to its level where no unit is told.
struct ChangeModel {
    double slope_sd_per_year = 0.03; ///< of a steady trend, and ...
    double slope_sd_um_per_year = 100;
    double walk_sd_per_root_year = 0.007; ///< what it wanders beside
    double season_sd = 0.007;             ///< between winter and summer
    double min_step = 0.1;                ///< less is no resurfacing
    double min_step_um = 200;
    double step_nats = 9; ///< by which a step must make the readings likelier: chance alone gives
                          ///< so much once in some 5,000 segments of 60 months
};

/// How a car or a pass that is off is told from one that is not.
struct TailModel {
    double dof = 4;        ///< of Student's t
    double scatter_sd = 0; ///< of the readings, whatever they claim: a car is judged by it where it
                           ///< is less than the car's own
};

/// Of what the errors of passes are made. The sd that a pass states is of what is wrong with its
/// car and with the method; passes differ by more, because no two drives are alike.
struct FusionConfig {
    double common_share = 0.5; ///< of the stated variance, alike in all cars: the same model, the
                               ///< same road between the tracks (docs/method/fusion.md)
    double car_share = 0.5;    ///< of the stated variance, alike in all passes of a car
    double trip_relative_sd = 0.02;    ///< alike in all passes of a trip: load, tyres, weather
    double rest_relative_sd = 0.07746; ///< of each pass: wander, speed; with trips together 0.08
    double rest_sd_mm_per_m = 0.05;
    double anchor_relative_sd = 0; ///< of all cars together, once they are calibrated
    TailModel tail{};
    ChangeModel change{};
};

} // namespace macadam
