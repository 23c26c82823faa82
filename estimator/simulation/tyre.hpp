#pragma once

#include "estimator/simulation/car_model.hpp"
#include "estimator/simulation/random.hpp"

#include <array>
#include <vector>

namespace macadam {

/// Road smoothed over the contact of the tyres, with a cubic between stations. It is level beyond
/// its ends.
class EnvelopedRoad {
public:
    EnvelopedRoad(const RoadUnderWheels& road, double contact_m);

    struct Heights {
        double left_m, right_m;
    };
    Heights at(double station_m) const;

private:
    struct Station {
        float left_m, right_m;
    };

    double per_m_;
    double last_;
    std::vector<Station> station_; ///< one extra in front, two behind
};

/// Non-uniformity of the wheels: a height over the turn of each that exerts the recipe's forces on
/// the tyre at one and two cycles per turn. Each wheel has its own phases and turns slightly faster
/// or slower than the others, as worn tyres do.
class TyreNonUniformity {
public:
    TyreNonUniformity(const CarRecipe& car, Random& random);

    /// Returns the height of one wheel whose axle has rolled travel_m, from -1000 m on.
    double at(std::size_t wheel, double travel_m) const;

private:
    static constexpr std::size_t part_count = 512;

    std::array<std::array<double, part_count + 1>, 4> height_m_{};
    PerWheel turns_per_m_{};
};

} // namespace macadam
