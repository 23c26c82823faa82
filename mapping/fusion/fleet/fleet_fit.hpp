#pragma once

#include "mapping/fusion/fleet/anderson_mixing.hpp"
#include "mapping/fusion/fleet/fleet_calibration.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace macadam {

/// Runs the fit of calibrate_fleet step by step.
class FleetFit {
public:
    /// Current estimate of one car.
    struct Car {
        double gain = 1;
        double offset_um = 0;
        double error_at_middle = 0; ///< relative, at the fleet's median level
        double variance_at_middle = 0;
    };

    /// \param readings  in the order of places, which are numbered from 0 without gaps.
    /// \param anchor_weights  weight of each car in the mean that is taken as correct; 1: the
    /// prior's
    /// \param scatter  factor on the sd of each car's readings; empty: all are 1
    FleetFit(const std::vector<FleetReading>& readings,
             const std::vector<std::optional<double>>& known,
             const FleetPrior& prior,
             const std::vector<double>& anchor_weights,
             const std::vector<double>& scatter = {});

    /// Updates levels, then trips and cars, then weights, once each, and accelerates the updates.
    /// \returns the relative change of the cars by the updates.
    double settle();

    /// Estimates the spread of trips and passes from the residuals.
    void take_spread();

    /// Returns the scatter of each car's residuals over the sds used in the fit without `scatter`;
    /// 1 for known sources, and where nearly all readings determine their level.
    std::vector<double> scatter_of_cars() const;

    /// Estimates the spread between those cars that count, robustly.
    /// \param about  mean error of the cars
    double spread_of_cars(const std::vector<bool>& counts, double about) const;

    std::size_t place_count() const { return first_of_place_.size() - 1; }

    double middle_um() const { return middle_um_; } ///< median level of the places

    std::vector<Car> cars;
    /// Local error that the cars share, seen where a known source passed.
    struct LocalError {
        double variance = 0; ///< relative, of a place
        double count = 0;    ///< of independent places
    };
    LocalError local_error() const;

    double trip_sd;
    double rest_sd;
    std::optional<double> anchor_sd; ///< of the levels, relative, if there are known sources

private:
    struct Trip {
        std::uint32_t car;
        double error = 0; ///< relative
        double w = 0, wz = 0, wzz = 0, wr = 0, wzr = 0;
        double readings = 0;
    };

    Eigen::VectorXd errors() const;
    void set_errors(const Eigen::VectorXd& errors);
    double variance_of(std::size_t reading) const;
    double residual(std::size_t reading) const;
    double expected(std::size_t reading) const;
    void fit_levels();
    void fit_known();
    bool is_certain(std::size_t car) const;
    double mean_variance() const;
    double known_and_cars(double mean_error);
    double level_of_others(std::size_t reading) const;
    void sum_trips();
    void fit_cars();
    void centre_cars();
    void trust_readings();

    const std::vector<FleetReading>* readings_;
    const std::vector<std::optional<double>>* known_;
    const std::vector<double>* anchor_weights_;
    std::vector<double> scatter_;        ///< of each car
    std::vector<double> known_variance_; ///< of the gain of each known source; 0: not compared
    double car_sd_;                      ///< spread of the cars
    double mean_error_ = 0;              ///< of the cars, if there are known sources
    FleetPrior prior_;
    std::vector<std::size_t> first_of_place_; ///< index of the first reading, plus an end sentinel
    std::vector<double> level_um_;            ///< of each place
    std::vector<double> trust_;               ///< weight of each reading, > 0
    std::vector<double> leverage_;            ///< of each reading on its level, 0 to 1
    std::vector<Trip> trips_;
    double middle_um_ = 1;
    AndersonMixing mixing_;
};

} // namespace macadam
