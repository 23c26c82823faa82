#pragma once

#include "estimator/smoother/driven_road.hpp"

#include <array>
#include <span>
#include <vector>

namespace macadam::field_test {

/// The paper's classes of reference IRI and the kilometres that it drove in each (its table IV).
struct Band {
    double from_mm_per_m, to_mm_per_m;
    double km;
};
inline constexpr std::array bands{
    Band{0, 2, 190.9}, Band{2, 4, 30.2}, Band{4, 6, 7.3}, Band{6, 12, 2.4}};

inline constexpr double segment_m = 40;

/// Which band a reference belongs to; bands.size(): to none.
std::size_t band_of(double reference_mm_per_m);

/// A piece of the reference survey: what the laser car measured, and where the other car is
/// thought to have been over it.
struct ReferencePiece {
    double from_m;             ///< of the lane
    double reference_mm_per_m; ///< MRI of the tracks that the laser car drove
    double shift_m;            ///< by which satellites put the other car ahead of its true place
};

/// One lane, as the two cars met it.
struct Lane {
    testing::DriveRecipe drive;
    RoadUnderWheels under_car;          ///< the tracks that the car with the IMU drove
    testing::TrueStroke driven;         ///< E1926 of these tracks
    std::vector<ReferencePiece> pieces; ///< those that count
};

/// What a lane is made from: a number, and the roughness aimed at.
struct LanePlan {
    std::uint64_t number;
    std::size_t band;
    std::vector<std::size_t> counted; ///< its pieces that fill the bands
};

/// Lanes until every band has its share of the paper's kilometres; pieces of bands that are full
/// are left out.
///
/// \param share  of the paper's kilometres, 0 < share <= 1
std::vector<LanePlan> plan_of(double share);

/// The lane of a plan, driven by a car whose parameters are not quite the file's.
Lane lane_of(const LanePlan& plan);

/// The car as its file has it: table III of the paper on the two axles of an Audi A6 e-tron.
Vehicle stated_car();

} // namespace macadam::field_test
