#pragma once

#include "mapping/fusion/fleet_calibration.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace macadam {

/// Of a normal distribution: sd over median absolute deviation.
inline constexpr double sd_over_mad_of_normal = 1.4826;

/// 0 of none.
double median_of(std::vector<double> values);

/// The fit of calibrate_fleet, step by step.
class FleetFit {
public:
    /// One car as it is seen so far.
    struct Car {
        double gain = 1;
        double offset_um = 0;
        double error_at_middle = 0; ///< relative, at the fleet's middle level
        double variance_at_middle = 0;
    };

    /// \param readings  in the order of places, which count from 0 without a gap.
    FleetFit(const std::vector<FleetReading>& readings,
             const std::vector<std::optional<double>>& known,
             const FleetPrior& prior);

    /// Levels, then trips and cars, then trust, each once. \returns how far cars moved, relative.
    double settle();

    /// Takes the spread of trips and of passes from what is left.
    void take_spread();

    std::size_t place_count() const { return first_of_place_.size() - 1; }

    std::vector<Car> cars;
    double trip_sd;
    double rest_sd;
    std::optional<double> known_sd; ///< of the fleet against what is known, relative

private:
    struct Trip {
        std::uint32_t car;
        double error = 0; ///< relative
        double w = 0, wz = 0, wzz = 0, wr = 0, wzr = 0;
        double readings = 0;
    };

    double variance_of(std::size_t reading) const;
    double expected(std::size_t reading) const;
    void fit_levels();
    void hold_against_known();
    void sum_trips();
    void fit_cars();
    void centre_cars();
    void trust_readings();

    const std::vector<FleetReading>* readings_;
    const std::vector<std::optional<double>>* known_;
    FleetPrior prior_;
    std::vector<std::size_t> first_of_place_; ///< and one past the last
    std::vector<double> level_um_;            ///< of each place
    std::vector<double> trust_;               ///< of each reading, above 0
    std::vector<double> leverage_;            ///< of each reading on its level, 0 to 1
    std::vector<Trip> trips_;
    double middle_um_ = 1;
};

} // namespace macadam
