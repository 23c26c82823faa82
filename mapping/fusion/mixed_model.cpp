#include "mapping/fusion/mixed_model.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr int max_rounds = 50;   // each round shrinks the step by a factor of 2 to 10
constexpr double settled = 1e-6; // in sds of the readings

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

double square(double x) {
    return x * x;
}

double precision_in(const FusionObservations& readings, const RobustWeights& trust, Index i) {
    return trust.of_reading[i] / square(readings.rest_sd[i]);
}

/// Readings of a car that share a trip error, or one reading without any.
struct Run {
    Index first, count;
    double trip_variance;
};

/// A car with its runs, computed once for all rounds.
struct CarRuns {
    FusionObservations::Block readings;
    std::span<const Run> runs;
    Index trips;
};

class Cars {
public:
    explicit Cars(const FusionObservations& readings) {
        runs_.reserve(static_cast<std::size_t>(readings.values.size())); // spans point into it
        cars_.reserve(readings.cars.size());
        auto trip = readings.trips.begin();
        for (const auto& [first, count] : readings.cars) {
            CarRuns car{{first, count}, {}, 0};
            const auto before = runs_.size();
            for (auto i = first; i < first + count; i += runs_.back().count) {
                if (trip != readings.trips.end() && trip->first == i) {
                    runs_.push_back({i, trip->count, square(readings.trip_sd)});
                    ++car.trips;
                    ++trip;
                } else {
                    runs_.push_back({i, 1, 0});
                }
            }
            car.runs = std::span{runs_}.subspan(before);
            cars_.push_back(car);
        }
    }

    Cars(const Cars&) = delete;
    Cars& operator=(const Cars&) = delete;

    auto begin() const { return cars_.begin(); }
    auto end() const { return cars_.end(); }

private:
    std::vector<Run> runs_;
    std::vector<CarRuns> cars_;
};

// ---------------------------------------------------------------------------- normal equations

/// Adds weight * row * row^T to the lower triangle of a matrix. Rows are mostly 0: changes before
/// the reading.
template <typename Row>
void add_square(MatrixXd& matrix, const Row& row, double weight) {
    const auto size = matrix.rows();
    for (Index column = 0; column < size; ++column) {
        if (const double factor = weight * row[column]; factor != 0) {
            double* const to = &matrix(0, column);
            for (Index i = column; i < size; ++i) {
                to[i] += factor * row[i];
            }
        }
    }
}

/// Normal equations of a mean model and its readings, solved for given weights. The errors common
/// to a car or a trip are eliminated with the Sherman-Morrison identity, so that the inverse
/// covariance is only needed within sums over readings.
class NormalEquations {
public:
    NormalEquations(const FusionObservations& readings, const MeanModel& mean)
        : readings_{&readings}, mean_{&mean}, cars_{readings},
          rows_(readings.values.size(), mean.columns.cols() + 1), sums_(rows_.cols(), rows_.cols()),
          of_trip_(rows_.cols()), of_car_(rows_.cols()), solver_{mean.columns.cols()} {
        rows_.leftCols(mean.columns.cols()) = mean.columns;
        rows_.rightCols<1>() = readings.values;
    }

    const Cars& cars() const { return cars_; }

    const VectorXd& solve(const RobustWeights& trust) {
        sums_.setZero();
        for (Index i = 0; const auto& car : cars_) {
            add_car(car, trust, trust.of_car[i++]);
        }
        const auto count = mean_->columns.cols();
        sums_.diagonal().head(count) += mean_->precisions;
        solver_.compute(sums_.topLeftCorner(count, count));
        coefficients_ = sums_.row(count).head(count).transpose();
        solver_.solveInPlace(coefficients_);
        return coefficients_;
    }

    /// Returns the last solution.
    LeastSquaresFit fit() const {
        const auto count = mean_->columns.cols();
        return {coefficients_, solver_.solve(MatrixXd::Identity(count, count))};
    }

private:
    auto row(Index reading) const { return rows_.row(reading); }

    /// Returns the weight of a reading that is alone in its run.
    double alone(const Run& run, const RobustWeights& trust) const {
        const double precision = precision_in(*readings_, trust, run.first);
        return precision / (1 + precision * run.trip_variance);
    }

    void add_car(const CarRuns& car, const RobustWeights& trust, double of_car) {
        const auto& sd = readings_->car_sd;
        if (car.readings.count == 1) {
            const auto i = car.readings.first;
            const double precision = alone(car.runs.front(), trust);
            add_square(sums_, row(i), precision / (1 + precision * square(sd[i]) / of_car));
            return;
        }
        of_car_.setZero();
        double loaded = 0;
        for (const auto& run : car.runs) {
            loaded += run.count == 1 ? add_alone(run, trust) : add_trip(run, trust);
        }
        add_square(sums_, of_car_, -1 / (of_car + loaded));
    }

    /// \returns  squared sd of the car's part in the reading, times its weight
    double add_alone(const Run& run, const RobustWeights& trust) {
        const auto i = run.first;
        const double precision = alone(run, trust);
        const double load = precision * readings_->car_sd[i];
        add_square(sums_, row(i), precision);
        of_car_ += load * row(i).transpose();
        return load * readings_->car_sd[i];
    }

    double add_trip(const Run& trip, const RobustWeights& trust) {
        of_trip_.setZero();
        double whole = 0, loads = 0, loaded = 0;
        for (Index i = trip.first; i < trip.first + trip.count; ++i) {
            const double precision = precision_in(*readings_, trust, i);
            const double load = precision * readings_->car_sd[i];
            add_square(sums_, row(i), precision);
            of_trip_ += precision * row(i).transpose();
            of_car_ += load * row(i).transpose();
            whole += precision;
            loads += load;
            loaded += load * readings_->car_sd[i];
        }
        const double alike = trip.trip_variance / (1 + whole * trip.trip_variance);
        add_square(sums_, of_trip_, -alike);
        of_car_ -= alike * loads * of_trip_;
        return loaded - alike * square(loads);
    }

    const FusionObservations* readings_;
    const MeanModel* mean_;
    Cars cars_;
    MeanColumns rows_; ///< design columns, then the value
    MatrixXd sums_;    ///< lower triangle of rows^T * V^-1 * rows
    VectorXd of_trip_;
    VectorXd of_car_;
    VectorXd coefficients_;
    Eigen::LDLT<MatrixXd> solver_;
};

// --------------------------------------------------------------------------------------- trust

/// Common deviation of a car's readings from the mean, with its variances.
struct CarOff {
    double off;
    double own_variance;   ///< of the car's part, as stated
    double noise_variance; ///< of trip errors and residuals in the mean of its readings
};

CarOff car_off(const FusionObservations& readings,
               const RobustWeights& trust,
               const VectorXd& residuals,
               const CarRuns& car) {
    double precision = 0, sum = 0, own = 0;
    const auto& [first, count] = car.readings;
    for (Index i = first; i < first + count; ++i) {
        const double weight = precision_in(readings, trust, i);
        precision += weight;
        sum += weight * residuals[i];
        own += weight * readings.car_sd[i] * readings.car_sd[i];
    }
    const double of_trips =
        car.trips > 0 ? square(readings.trip_sd) / static_cast<double>(car.trips) : 0;
    return {sum / precision, own / precision, 1 / precision + of_trips};
}

double trusted(double squared_sds, double dof) {
    return dof / (dof + squared_sds);
}

/// Returns the -log density of Student's t matching the weights of `trusted`, for a variance that
/// is `scale` times the one used for judging.
double surprise(double squared_sds, double dof, double scale) {
    return scale * (dof + 1) / 2 * std::log1p(squared_sds / dof);
}

/// Basis for judging a car.
struct CarJudgement {
    CarOff off;
    double seen;        ///< variance of its mean, limited to the observed scatter
    double squared_sds; ///< deviation of its mean
};

CarJudgement judgement_of(const FusionObservations& readings,
                          const RobustWeights& trust,
                          const VectorXd& residuals,
                          const TailModel& tail,
                          const CarRuns& car) {
    const auto off = car_off(readings, trust, residuals, car);
    const double seen = std::min(off.own_variance, square(tail.scatter_sd)) + off.noise_variance;
    return {off, seen, square(off.off) / seen};
}

double
squared_rest(const FusionObservations& readings, double residual, const CarOff& off, Index i) {
    return square((residual - off.off) / readings.rest_sd[i]);
}

/// Updates the weights of each car and each reading from their deviations.
void judge(RobustWeights& next,
           const RobustWeights& before,
           const FusionObservations& readings,
           const Cars& cars,
           const VectorXd& residuals,
           const TailModel& tail) {
    for (Index c = 0; const auto& car : cars) {
        const auto [off, seen, sds2] = judgement_of(readings, before, residuals, tail, car);
        const double own = off.own_variance, noise = off.noise_variance;
        // Judges the mean of the car's readings: a car of one pass is that pass.
        const double widened = (own + noise) / trusted(sds2, tail.dof) - noise;
        next.of_car[c++] = own > 0 ? own / widened : 1;
        const auto& [first, count] = car.readings;
        for (Index i = first; count > 1 && i < first + count; ++i) {
            next.of_reading[i] = trusted(squared_rest(readings, residuals[i], off, i), tail.dof);
        }
    }
}

/// Returns the -log likelihood of the deviations from the mean, up to a constant.
double misfit_of(const RobustWeights& trust,
                 const FusionObservations& readings,
                 const Cars& cars,
                 const VectorXd& residuals,
                 const TailModel& tail) {
    double misfit = 0;
    for (const auto& car : cars) {
        const auto [off, seen, sds2] = judgement_of(readings, trust, residuals, tail, car);
        misfit += surprise(sds2, tail.dof, seen / (off.own_variance + off.noise_variance));
        const auto& [first, count] = car.readings;
        for (Index i = first; count > 1 && i < first + count; ++i) {
            misfit += surprise(squared_rest(readings, residuals[i], off, i), tail.dof, 1);
        }
    }
    return misfit;
}

} // namespace

RobustWeights full_trust(const FusionObservations& readings) {
    return {VectorXd::Ones(readings.values.size()),
            VectorXd::Ones(static_cast<Index>(readings.cars.size()))};
}

VectorXd
without_errors(const FusionObservations& readings, const RobustWeights& trust, VectorXd column) {
    const VectorXd precision = trust.of_reading.cwiseQuotient(readings.rest_sd.cwiseAbs2());
    VectorXd loads = precision.cwiseProduct(readings.car_sd);
    column = column.cwiseProduct(precision).eval();
    const double variance = square(readings.trip_sd);
    for (const auto& [first, count] : readings.trips) {
        const auto alike = precision.segment(first, count);
        const double share = variance / (1 + variance * alike.sum());
        column.segment(first, count) -= share * column.segment(first, count).sum() * alike;
        loads.segment(first, count) -= share * loads.segment(first, count).sum() * alike;
    }
    for (Index i = 0; const auto& [first, count] : readings.cars) {
        const auto sd = readings.car_sd.segment(first, count);
        const auto load = loads.segment(first, count);
        const double off = sd.dot(column.segment(first, count));
        column.segment(first, count) -= off / (trust.of_car[i++] + sd.dot(load)) * load;
    }
    return column;
}

LeastSquaresFit
fit_mean(const FusionObservations& readings, const MeanModel& mean, const RobustWeights& trust) {
    NormalEquations equations{readings, mean};
    equations.solve(trust);
    return equations.fit();
}

RobustFit fit_student_t(const FusionObservations& readings,
                        const MeanModel& mean,
                        const TailModel& tail,
                        const VectorXd& start) {
    const double enough = settled * readings.rest_sd.minCoeff();
    NormalEquations equations{readings, mean};
    const auto& cars = equations.cars();
    auto trust = full_trust(readings);
    auto next = trust;
    VectorXd before = start;
    VectorXd residuals = readings.values - start;
    judge(next, trust, readings, cars, residuals, tail);
    for (int round = 0; round < max_rounds; ++round) {
        std::swap(trust, next);
        const VectorXd expected = mean.columns * equations.solve(trust);
        residuals = readings.values - expected;
        if ((expected - before).cwiseAbs().maxCoeff() < enough) {
            break;
        }
        judge(next, trust, readings, cars, residuals, tail);
        before = expected;
    }
    auto fit = equations.fit();
    const double known = mean.precisions.dot(fit.coefficients.cwiseAbs2()) / 2;
    return {std::move(fit), trust, misfit_of(trust, readings, cars, residuals, tail) + known};
}

VectorXd influence_on(const FusionObservations& readings,
                      const MeanModel& mean,
                      const RobustWeights& trust,
                      const LeastSquaresFit& fit,
                      Index coefficient) {
    return without_errors(readings, trust, mean.columns * fit.inverse.col(coefficient));
}

double variance_of(const FusionObservations& readings, const VectorXd& influence) {
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
