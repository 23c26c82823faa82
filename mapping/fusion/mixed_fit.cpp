#include "mapping/fusion/mixed_fit.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

constexpr int most_rounds = 50;  // a round shrinks the step by 2 to 10
constexpr double settled = 1e-6; // of the readings' sd

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Takes the part of one effect out: from `m` = V^-1 columns of a block to (V + effect)^-1 columns,
/// where `loads` = V^-1 times what the effect adds to each reading.
template <typename Rows, typename Loads, typename Added>
void take_out(Rows m, const Loads& loads, const Added& added, double precision) {
    const double known = added.dot(loads);
    m -= loads * ((added.transpose() * m) / (precision + known)).eval();
}

/// What the readings of a car have in common beside the mean, and how sure that is.
struct CarOff {
    double off;
    double own_variance;   ///< of the car's part, as it claims
    double noise_variance; ///< of what the mean of its readings has of trips and rests
};

double precision_in(const Readings& readings, const Trust& trust, Index i) {
    return trust.of_reading[i] / (readings.rest_sd[i] * readings.rest_sd[i]);
}

std::ptrdiff_t trips_of(const Readings& readings, const Readings::Block& car) {
    const auto before = [&](Index end) {
        return std::ranges::lower_bound(readings.trips, end, {}, &Readings::Block::first);
    };
    return before(car.first + car.count) - before(car.first);
}

CarOff car_off(const Readings& readings,
               const Trust& trust,
               const VectorXd& residuals,
               const Readings::Block& car) {
    double precision = 0, sum = 0, own = 0;
    for (Index i = car.first; i < car.first + car.count; ++i) {
        const double weight = precision_in(readings, trust, i);
        precision += weight;
        sum += weight * residuals[i];
        own += weight * readings.car_sd[i] * readings.car_sd[i];
    }
    const auto trips = trips_of(readings, car);
    return {sum / precision,
            own / precision,
            1 / precision + readings.trip_sd * readings.trip_sd / static_cast<double>(trips)};
}

double trusted(double squared_sds, double dof) {
    return dof / (dof + squared_sds);
}

/// -log density of Student's t whose weights `trusted` gives, where a variance is judged by
/// another that is `scale` times as large.
double surprise(double squared_sds, double dof, double scale) {
    return scale * (dof + 1) / 2 * std::log1p(squared_sds / dof);
}

struct Judged {
    Trust trust;
    double misfit;
};

/// How far each car and each reading is to be believed that is off the mean by so much.
Judged judged(const Readings& readings,
              const Trust& before,
              const VectorXd& residuals,
              const TailModel& tail) {
    Judged next{before, 0};
    for (std::size_t c = 0; c < readings.cars.size(); ++c) {
        const auto& car = readings.cars[c];
        const auto [off, own, noise] = car_off(readings, before, residuals, car);
        const double seen = std::min(own, tail.scatter_sd * tail.scatter_sd) + noise;
        const double sds2 = off * off / seen;
        next.misfit += surprise(sds2, tail.dof, seen / (own + noise));
        // Of the mean of its readings as a whole: a car of one pass is that pass.
        const double widened = (own + noise) / trusted(sds2, tail.dof) - noise;
        next.trust.of_car[static_cast<Index>(c)] = own > 0 ? own / widened : 1;
        for (Index i = car.first; car.count > 1 && i < car.first + car.count; ++i) {
            const double rest2 = std::pow((residuals[i] - off) / readings.rest_sd[i], 2);
            next.trust.of_reading[i] = trusted(rest2, tail.dof);
            next.misfit += surprise(rest2, tail.dof, 1);
        }
    }
    return next;
}

} // namespace

Trust full_trust(const Readings& readings) {
    return {VectorXd::Ones(readings.values.size()),
            VectorXd::Ones(static_cast<Index>(readings.cars.size()))};
}

MatrixXd without_errors(const Readings& readings, const Trust& trust, const MatrixXd& columns) {
    const VectorXd precision = trust.of_reading.cwiseQuotient(readings.rest_sd.cwiseAbs2());
    MatrixXd m = precision.asDiagonal() * columns;
    VectorXd loads = precision.cwiseProduct(readings.car_sd);
    if (readings.trip_sd > 0) {
        const double of_trip = 1 / (readings.trip_sd * readings.trip_sd);
        for (const auto& [first, count] : readings.trips) {
            const VectorXd alike = precision.segment(first, count);
            const VectorXd ones = VectorXd::Ones(count);
            take_out(m.middleRows(first, count), alike, ones, of_trip);
            take_out(loads.middleRows(first, count), alike, ones, of_trip);
        }
    }
    for (Index i = 0; const auto& [first, count] : readings.cars) {
        take_out(m.middleRows(first, count),
                 loads.segment(first, count),
                 readings.car_sd.segment(first, count),
                 trust.of_car[i++]);
    }
    return m;
}

MeanFit fit_mean(const Readings& readings, const MeanModel& mean, const Trust& trust) {
    MeanFit fit;
    fit.weighed = without_errors(readings, trust, mean.columns);
    MatrixXd normal = mean.columns.transpose() * fit.weighed;
    normal.diagonal() += mean.precisions;
    const auto count = normal.rows();
    fit.inverse = normal.ldlt().solve(MatrixXd::Identity(count, count));
    fit.coefficients = fit.inverse * (fit.weighed.transpose() * readings.values);
    return fit;
}

RobustFit fit_robustly(const Readings& readings,
                       const MeanModel& mean,
                       const TailModel& tail,
                       const VectorXd& start) {
    const double enough = settled * readings.rest_sd.minCoeff();
    auto now = judged(readings, full_trust(readings), readings.values - start, tail);
    MeanFit fit;
    VectorXd before = start;
    for (int round = 0; round < most_rounds; ++round) {
        fit = fit_mean(readings, mean, now.trust);
        const VectorXd expected = mean.columns * fit.coefficients;
        auto next = judged(readings, now.trust, readings.values - expected, tail);
        const double moved = (expected - before).cwiseAbs().maxCoeff();
        now.misfit = next.misfit;
        if (moved < enough) {
            break;
        }
        now.trust = std::move(next.trust);
        before = expected;
    }
    const double known = mean.precisions.dot(fit.coefficients.cwiseAbs2()) / 2;
    return {std::move(fit), std::move(now.trust), now.misfit + known};
}

VectorXd influence_on(const MeanFit& fit, Index coefficient) {
    return fit.weighed * fit.inverse.col(coefficient);
}

double variance_of(const Readings& readings, const VectorXd& influence) {
    double variance = readings.rest_sd.cwiseProduct(influence).squaredNorm();
    for (const auto& [first, count] : readings.trips) {
        const double alike = readings.trip_sd * influence.segment(first, count).sum();
        variance += alike * alike;
    }
    for (const auto& [first, count] : readings.cars) {
        const double alike =
            readings.car_sd.segment(first, count).dot(influence.segment(first, count));
        variance += alike * alike;
    }
    return variance;
}

} // namespace macadam
