#include "estimator/smoother/filter/road_smoother.hpp"

#include "estimator/smoother/corners.hpp"
#include "estimator/smoother/filter/counter_rng.hpp"

#include <Eigen/Cholesky>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace macadam::testing {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double cell_m = 0.25;
constexpr double step_s = 0.02;
constexpr int zeros = channel_count;
constexpr int arms = pull_count;

// Of a car: its start, its channels' zeros and the arms of its pulls, as they begin.
constexpr int own = LinearCar::states + zeros + arms;

Vehicle short_car(double wheelbase_m) {
    auto vehicle = lopsided_car();
    vehicle.axles->wheelbase_m = wheelbase_m;
    vehicle.axles->cg_to_front_m = 0.45 * wheelbase_m;
    return vehicle;
}

/// A drive at a few metres a second, with readings of pure chance: the posterior is what it is
/// whatever was read.
DriveRecord made_drive(const Vehicle& vehicle, double from_m, std::size_t samples, unsigned seed) {
    std::mt19937 random{seed};
    std::normal_distribution<double> normal;
    DriveRecord drive;
    drive.cars = {car_steps(linear_car(vehicle), step_s)};
    double at_m = from_m;
    for (std::size_t k = 0; k < samples; ++k) {
        drive.travel_m.push_back(at_m);
        at_m += 0.12 + 0.1 * std::abs(std::sin(0.3 * static_cast<double>(k)));
    }
    const double sd[] = {0.4, 0.3, 0.02, 0.03};
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        for (std::size_t k = 0; k < samples; ++k) {
            drive.felt[channel].push_back(sd[channel] * normal(random));
            drive.variance[channel].push_back(0.01 * sd[channel] * sd[channel] *
                                              (1 + static_cast<double>(k % 3)));
        }
    }
    drive.drift = {1e-3, 1e-2, 1e-5, 1e-5};
    for (std::size_t k = 0; k < samples; ++k) {
        drive.pull[0].push_back(2 * std::sin(0.7 * static_cast<double>(k)));
        drive.pull[1].push_back(1 + std::cos(0.4 * static_cast<double>(k)));
    }
    return drive;
}

/// Smoothed from nothing.
SmoothedRoad road_of(const std::vector<DriveRecord>& drives,
                     const RoadGrid& grid,
                     const RoadPrior& prior,
                     std::uint64_t seed) {
    SmootherMemory memory;
    return smooth_road(drives, grid, prior, seed, memory);
}

/// A prior that differs from station to station, with covariance between its two sides.
RoadPrior uneven_prior(const RoadGrid& grid) {
    RoadPrior prior;
    prior.change_weights = {0.3, -0.2, 0.1};
    for (std::size_t i = 0; i < grid.cells; ++i) {
        const double q = 1e-6 * (1 + static_cast<double>(i % 5));
        prior.increments.push_back({q, 0.4 * q, (i % 2 == 0 ? 0.5 : -0.3) * std::sqrt(0.4) * q});
    }
    return prior;
}

/// Everything at once: increments (mean and half by turns), then for each car its start, the zeros
/// at its start and what they drift in each step.
struct Dense {
    Matrix map;      ///< readings by unknowns
    Matrix variance; ///< of the unknowns before
    Vector noise;    ///< variance of the readings
    Vector felt;
    Matrix profile; ///< by unknowns; mean and half by turns
};

/// States at every sample from a start and a road, by matrices as they stand; one pull, if any,
/// at an arm of a metre after a sample.
std::vector<States> driven(const DriveRecord& drive,
                           const RoadGrid& grid,
                           States x,
                           const std::vector<Pair>& road_m,
                           int pull = -1,
                           int after = 0) {
    std::vector<States> all{x};
    for (std::size_t k = 1; k < drive.travel_m.size(); ++k) {
        const auto& steps = car_at(drive, k);
        const double from_m = drive.travel_m[k - 1];
        const auto push = road_push(steps, from_m, drive.travel_m[k] - from_m, grid.cell_m);
        x = steps.phi * x;
        if (pull >= 0 && static_cast<int>(k) > after) {
            x += steps.lean.col(pull) * drive.pull[static_cast<std::size_t>(pull)][k];
        }
        for (const auto& axle : push.axles) {
            for (std::size_t i = 0; i < axle.cells; ++i) {
                const auto& pair = road_m[static_cast<std::size_t>(
                    axle.first + static_cast<std::ptrdiff_t>(i) - grid.first_cell)];
                for (int s = 0; s < LinearCar::states; ++s) {
                    const auto at = static_cast<std::size_t>(s);
                    x[s] += s < LinearCar::heave_states
                                ? axle.heave[i][at] * pair.mean
                                : axle.roll[i][at - LinearCar::heave_states] * pair.half;
                }
            }
        }
        all.push_back(x);
    }
    return all;
}

double start_sd(int state) { // as smooth_road has it before anything is felt
    const bool angle = state == 2 || state == 3 || state == 8 || state == 9;
    return state % 2 == 0 ? (angle ? 0.03 : 0.05) : (angle ? 0.2 : 0.3);
}

Dense dense_of(const std::vector<DriveRecord>& drives,
               const RoadGrid& grid,
               const RoadPrior& prior) {
    const auto cells = static_cast<int>(grid.cells);
    int unknowns = 2 * cells;
    int readings = 0;
    for (const auto& drive : drives) {
        const auto n = static_cast<int>(drive.travel_m.size());
        unknowns += own + (zeros + arms) * (n - 1);
        readings += zeros * n;
    }
    Dense dense{Matrix::Zero(readings, unknowns),
                Matrix::Zero(unknowns, unknowns),
                Vector(readings),
                Vector(readings),
                Matrix::Zero(2 * cells, unknowns)};
    const double keep[] = {std::exp(-grid.cell_m / prior.mean_length_m),
                           std::exp(-grid.cell_m / prior.half_length_m)};
    for (int cell = 0; cell < cells; ++cell) {
        auto q = prior.increments[static_cast<std::size_t>(cell)];
        if (cell == 0) { // the road has wandered from everlasting
            q = {q.mean / (1 - keep[0] * keep[0]), q.half / (1 - keep[1] * keep[1]), 0};
        }
        dense.variance.block<2, 2>(2 * cell, 2 * cell) << q.mean, q.cross, q.cross, q.half;
        for (int side = 0; side < 2; ++side) {
            // A road that changed here and nowhere else: `change` over what it keeps of its height.
            std::vector<double> change(grid.cells);
            double height = 0;
            for (int later = cell; later < cells; ++later) {
                const auto at = static_cast<std::size_t>(later);
                change[at] = later == cell ? 1 : 0;
                const std::size_t weights = side == 0 ? prior.change_weights.size() : 0;
                for (std::size_t i = 0; i < weights && i + 1 < at; ++i) {
                    // That of the first station is its height, which does not go on.
                    change[at] += prior.change_weights[i] * change[at - 1 - i];
                }
                height = keep[side] * height + change[at];
                dense.profile(2 * later + side, 2 * cell + side) = height;
            }
        }
    }
    int unknown = 2 * cells;
    int reading = 0;
    const std::vector<Pair> level_m(grid.cells);
    for (const auto& drive : drives) {
        const auto n = static_cast<int>(drive.travel_m.size());
        const auto put = [&](int column, const std::vector<States>& states) {
            for (int k = 0; k < n; ++k) {
                const auto at = static_cast<std::size_t>(k);
                for (int c = 0; c < zeros; ++c) {
                    dense.map(reading + zeros * k + c, column) =
                        car_at(drive, at).car.felt[static_cast<std::size_t>(c)] * states[at];
                }
            }
        };
        for (int column = 0; column < 2 * cells; ++column) {
            std::vector<Pair> road_m(grid.cells);
            for (int cell = 0; cell < cells; ++cell) {
                road_m[static_cast<std::size_t>(cell)] = {dense.profile(2 * cell, column),
                                                          dense.profile(2 * cell + 1, column)};
            }
            put(column, driven(drive, grid, States::Zero(), road_m));
        }
        for (int state = 0; state < LinearCar::states; ++state) {
            put(unknown + state, driven(drive, grid, States::Unit(state), level_m));
            dense.variance(unknown + state, unknown + state) = std::pow(start_sd(state), 2);
        }
        unknown += LinearCar::states;
        const double zero_sd[] = {1, 1, 0.1, 0.1};
        for (int k = 0; k < n; ++k) { // what a zero has moved until sample k stays in all later
            for (int c = 0; c < zeros; ++c) {
                dense.variance(unknown, unknown) =
                    k == 0 ? std::pow(zero_sd[c], 2)
                           : drive.drift[static_cast<std::size_t>(c)] * step_s;
                for (int later = k; later < n; ++later) {
                    dense.map(reading + zeros * later + c, unknown) = 1;
                }
                ++unknown;
            }
        }
        for (int pull = 0; pull < arms; ++pull) {
            for (int k = 0; k < n; ++k) {
                put(unknown, driven(drive, grid, States::Zero(), level_m, pull, k));
                dense.variance(unknown, unknown) = k == 0 ? 0.25 : 0.01 * step_s; // m^2
                ++unknown;
            }
        }
        for (int k = 0; k < n; ++k) {
            for (std::size_t c = 0; c < channel_count; ++c) {
                dense.felt[reading] = drive.felt[c][static_cast<std::size_t>(k)];
                dense.noise[reading] = drive.variance[c][static_cast<std::size_t>(k)];
                ++reading;
            }
        }
    }
    return dense;
}

struct Posterior {
    Vector profile_m; ///< mean and half by turns
    Matrix covariance;
    double log_likelihood;
};

Posterior posterior_of(const Dense& dense) {
    const Matrix across = dense.map * dense.variance;
    Matrix s = across * dense.map.transpose();
    s.diagonal() += dense.noise;
    const Eigen::LLT<Matrix> root{s};
    const Matrix lower = root.matrixL();
    const Matrix mapped = across * dense.profile.transpose();
    return {mapped.transpose() * root.solve(dense.felt),
            dense.profile * dense.variance * dense.profile.transpose() -
                mapped.transpose() * root.solve(mapped),
            -lower.diagonal().array().log().sum() - dense.felt.dot(root.solve(dense.felt)) / 2};
}

Vector flat(const std::vector<Pair>& pairs) {
    Vector values(2 * static_cast<int>(pairs.size()));
    for (int i = 0; i < static_cast<int>(pairs.size()); ++i) {
        values[2 * i] = pairs[static_cast<std::size_t>(i)].mean;
        values[2 * i + 1] = pairs[static_cast<std::size_t>(i)].half;
    }
    return values;
}

std::vector<DriveRecord> one_drive() {
    return {made_drive(short_car(1.3), 3, 20, 1)};
}

/// Two cars of different length over one road; the second one's damping changes on the way.
std::vector<DriveRecord> two_drives() {
    auto second = made_drive(short_car(0.9), 3.4, 18, 2);
    auto harder = short_car(0.9);
    harder.half_car.cs_ns_per_m *= 1.5;
    second.cars.push_back(car_steps(linear_car(harder), step_s));
    for (std::size_t k = 0; k < second.travel_m.size(); ++k) {
        second.which.push_back(k > 6 && k < 12 ? 1 : 0);
    }
    return {made_drive(short_car(1.3), 3, 16, 1), second};
}

void expect_the_posterior(const std::vector<DriveRecord>& drives) {
    const auto grid = grid_under(drives, cell_m);
    const auto prior = uneven_prior(grid);
    const auto expected = posterior_of(dense_of(drives, grid, prior));
    const auto road = road_of(drives, grid, prior, 1);
    const Vector ours = flat(road.profile_m);
    // Covariances of six decades are taken off each other some hundred times.
    EXPECT_LT((ours - expected.profile_m).norm(), 1e-6 * expected.profile_m.norm());
    EXPECT_NEAR(road.log_likelihood, expected.log_likelihood, 1e-4);
}

DriveRecord with_channels(DriveRecord drive, std::initializer_list<std::size_t> channels) {
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        if (std::ranges::find(channels, channel) == channels.end()) {
            drive.felt[channel].clear();
            drive.variance[channel].clear();
        }
    }
    return drive;
}

/// The same as of the whole drive with channels that say nothing.
void expect_the_mean_of_the_rest(const std::vector<DriveRecord>& deaf, DriveRecord whole) {
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        if (deaf[0].felt[channel].empty()) {
            std::ranges::fill(whole.variance[channel], 1e12);
        }
    }
    const std::vector<DriveRecord> drives{std::move(whole)};
    const auto grid = grid_under(drives, cell_m);
    const auto prior = uneven_prior(grid);
    const Vector expected = posterior_of(dense_of(drives, grid, prior)).profile_m;
    const Vector ours = flat(road_of(deaf, grid, prior, 1).profile_m);
    EXPECT_LT((ours - expected).norm(), 1e-6 * expected.norm());
}

/// The draws' own covariance over many seeds, in units of the posterior's deviations.
Matrix drawn_covariance(const std::vector<DriveRecord>& drives,
                        const RoadGrid& grid,
                        const RoadPrior& prior,
                        const Matrix& unit,
                        int seeds) {
    Matrix sum = Matrix::Zero(unit.rows(), unit.rows());
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto road = road_of(drives, grid, prior, static_cast<std::uint64_t>(seed));
        const Vector z = unit * flat(road.perturbation_m).head(unit.cols());
        sum += z * z.transpose();
    }
    return sum / seeds;
}

} // namespace

TEST(RoadFilter, FindsTheMeanOfTheDensePosterior) {
    expect_the_posterior(one_drive());
}

TEST(RoadFilter, FindsTheMeanOfTheDensePosteriorOfTwoDrives) {
    expect_the_posterior(two_drives());
}

TEST(RoadFilter, WithoutSomeChannelsFindsTheMeanOfWhatIsLeft) {
    const auto whole = one_drive();
    expect_the_mean_of_the_rest({with_channels(whole[0], {0, 2})}, whole[0]);
}

/// What nothing felt depends on is left out of the filter, and nothing is lost by it.
TEST(RoadFilter, OfTheVerticalAloneFindsTheMeanThatTheWholeCarWould) {
    auto straight = short_car(1.3);
    straight.imu.y_m = 0;
    const std::vector<DriveRecord> deaf{with_channels(made_drive(straight, 3, 20, 1), {0})};
    expect_the_mean_of_the_rest(deaf, made_drive(straight, 3, 20, 1));
}

TEST(RoadFilter, OfOneAxleFindsTheMeanThatTheWholeCarWould) {
    auto short_one = short_car(1.3);
    short_one.axles.reset();
    const std::vector<DriveRecord> deaf{with_channels(made_drive(short_one, 3, 20, 1), {0, 2})};
    expect_the_mean_of_the_rest(deaf, made_drive(short_one, 3, 20, 1));
}

/// Drawn roads, whitened by the dense posterior, are white. 600 seeds know a variance to 6 % and
/// the mean of 2 n of them to that over sqrt(2 n).
TEST(RoadFilter, DrawsRoadsWithTheCovarianceOfTheDensePosterior) {
    const auto drives = two_drives();
    const auto grid = grid_under(drives, cell_m);
    const auto prior = uneven_prior(grid);
    const auto posterior = posterior_of(dense_of(drives, grid, prior));
    const int n = static_cast<int>(posterior.covariance.rows()) - 2; // no one comes to the last
    const Matrix driven_over = posterior.covariance.topLeftCorner(n, n);
    const Matrix lower = Eigen::LLT<Matrix>{driven_over}.matrixL();
    const Matrix unit = lower.triangularView<Eigen::Lower>().solve(Matrix::Identity(n, n));
    constexpr int seeds = 600;
    const Matrix drawn = drawn_covariance(drives, grid, prior, unit, seeds);
    EXPECT_NEAR(drawn.diagonal().mean(), 1, 5 * std::sqrt(2.0 / seeds / n));
    EXPECT_LT((drawn.diagonal().array() - 1).abs().maxCoeff(), 5 * std::sqrt(2.0 / seeds));
    Matrix beside = drawn;
    beside.diagonal().setZero();
    EXPECT_LT(beside.cwiseAbs().maxCoeff(), 5.5 * std::sqrt(1.0 / seeds)) << n * (n - 1) / 2;
}

TEST(RoadFilter, DrawsOtherRoadsOfOtherSeeds) {
    const auto drives = one_drive();
    const auto grid = grid_under(drives, cell_m);
    const auto prior = uneven_prior(grid);
    const auto one = flat(road_of(drives, grid, prior, 1).perturbation_m);
    const auto again = flat(road_of(drives, grid, prior, 1).perturbation_m);
    const auto two = flat(road_of(drives, grid, prior, 2).perturbation_m);
    EXPECT_EQ(one, again);
    EXPECT_GT((one - two).norm(), 0.5 * one.norm());
}

/// Innovations over their deviations are as many standard normal numbers if the readings come from
/// the model itself: their mean square is 1 to 5 sd of a chi-square.
TEST(RoadFilter, IsSurprisedAsMuchAsItExpects) {
    const auto drives = one_drive();
    const auto grid = grid_under(drives, cell_m);
    const auto prior = uneven_prior(grid);
    const auto dense = dense_of(drives, grid, prior);
    Matrix s = dense.map * dense.variance * dense.map.transpose();
    s.diagonal() += dense.noise;
    const Matrix lower = Eigen::LLT<Matrix>{s}.matrixL();
    double squares = 0;
    double count = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Vector z(s.rows());
        for (int i = 0; i < z.size(); ++i) {
            z[i] = counter_normal(seed, 1, static_cast<std::uint64_t>(i), 0);
        }
        const Vector felt = lower * z;
        auto drawn = drives;
        for (int i = 0; i < felt.size(); ++i) {
            drawn[0]
                .felt[static_cast<std::size_t>(i % zeros)][static_cast<std::size_t>(i / zeros)] =
                felt[i];
        }
        for (const double e : road_of(drawn, grid, prior, 1).innovation) {
            squares += e * e;
            ++count;
        }
    }
    EXPECT_NEAR(squares / count, 1, 5 * std::sqrt(2 / count));
}

/// Fifty metres from both ends of a piece a hundredth of what its ends move is left.
TEST(RoadFilter, DrawsTheSameRoadHoweverTheTripIsCut) {
    const auto whole = made_drive(lopsided_car(), 0, 1000, 1);
    auto piece = whole;
    constexpr std::size_t from = 100;
    constexpr std::size_t to = 900;
    const auto cut = [](std::vector<double>& values) {
        values = std::vector<double>(values.begin() + from, values.begin() + to);
    };
    cut(piece.travel_m);
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        cut(piece.felt[channel]);
        cut(piece.variance[channel]);
    }
    for (auto& pull : piece.pull) {
        cut(pull);
    }
    piece.first_sample = from;
    const auto even_road_of = [](const DriveRecord& drive, const RoadGrid& grid) {
        RoadPrior prior;
        prior.increments.assign(grid.cells, {2e-6, 8e-7, 0});
        return road_of({drive}, grid, prior, 5);
    };
    const auto grid = grid_under({&whole, 1}, cell_m);
    const auto grid_cut = grid_under({&piece, 1}, cell_m);
    const auto all = even_road_of(whole, grid);
    const auto some = even_road_of(piece, grid_cut);
    double apart = 0;
    double power = 0;
    const auto first = static_cast<std::ptrdiff_t>((piece.travel_m.front() + 50) / cell_m);
    const auto last = static_cast<std::ptrdiff_t>((piece.travel_m.back() - 50) / cell_m);
    ASSERT_GT(last - first, 40);
    for (std::ptrdiff_t cell = first; cell < last; ++cell) {
        const auto& a = all.perturbed_m[static_cast<std::size_t>(cell - grid.first_cell)];
        const auto& b = some.perturbed_m[static_cast<std::size_t>(cell - grid_cut.first_cell)];
        apart += std::pow(a.mean - b.mean, 2) + std::pow(a.half - b.half, 2);
        power += a.mean * a.mean + a.half * a.half;
    }
    EXPECT_LT(std::sqrt(apart / power), 0.01);
}

TEST(GridUnder, ReachesUnderEveryWheelAndBeginsAtAWholeMetre) {
    const auto drive = made_drive(lopsided_car(), 7.3, 30, 1);
    const auto grid = grid_under({&drive, 1}, cell_m);
    const double first_m = static_cast<double>(grid.first_cell) * cell_m;
    const double last_m = first_m + static_cast<double>(grid.cells - 1) * cell_m;
    EXPECT_EQ(first_m, std::floor(first_m));
    EXPECT_LE(first_m, 7.3 - 1.5);
    EXPECT_GE(last_m, drive.travel_m.back() + 1.25);
}

} // namespace macadam::testing
