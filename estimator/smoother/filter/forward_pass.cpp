#include "estimator/smoother/filter/counter_rng.hpp"
#include "estimator/smoother/filter/forward_backward.hpp"
#include "estimator/smoother/filter/sparse_transition.hpp"
#include "estimator/smoother/filter/vector_kernels.hpp"

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

using Vector = std::vector<double>;

constexpr auto states = static_cast<std::size_t>(LinearCar::states);

// Prior standard deviations of a car's state; start-up forgets them.
constexpr double start_m = 0.05;
constexpr double start_mps = 0.3;
constexpr double start_rad = 0.03;
constexpr double start_radps = 0.2;
constexpr std::array<double, channel_count> start_zero{1, 1, 0.1, 0.1}; // m/s^2, rad/s

// Lever arms of cars: their height above the ground or the roll axis, less the effect of the
// suspension's links. They differ between braking and driving off, and while the brake force
// shifts.
constexpr double start_arm_m = 0.5;
constexpr double arm_drift_m2ps = 0.01;

// Purposes of the random numbers.
constexpr std::uint64_t for_start = 1;
constexpr std::uint64_t for_road = 2;
constexpr std::uint64_t for_zero = 3;
constexpr std::uint64_t for_noise = 4;
constexpr std::uint64_t for_arm = 5;

std::uint64_t of_car(std::uint64_t what, std::size_t car) {
    return what + 8 * car;
}

double start_sd(std::size_t state) {
    const bool angle = state == 2 || state == 3 || state == 8 || state == 9;
    return state % 2 == 0 ? (angle ? start_rad : start_m) : (angle ? start_radps : start_mps);
}

std::size_t readings_of(std::span<const DriveRecord> drives) {
    std::size_t count = 0;
    for (const auto& drive : drives) {
        for (const auto& felt : drive.felt) {
            count += felt.size();
        }
    }
    return count;
}

/// Kalman filter: the estimate, its covariance, and the error of a drawn road with drawn readings.
class Filter {
public:
    Filter(std::span<const DriveRecord> drives,
           const RoadGrid& grid,
           const RoadPrior& prior,
           std::uint64_t seed,
           SmootherMemory memory)
        : drives_{drives}, grid_{grid}, prior_{prior}, seed_{seed},
          pass_{.layout = layout_of(drives, grid),
                .processes = road_processes(prior, grid.cell_m),
                .events = events_of(drives, grid.cell_m)},
          size_{pass_.layout.size}, p_(size_ * size_), moved_(states * size_), gain_(size_),
          estimate_(size_), error_(size_) {
        pass_.drawn.resize(grid.cells);
        pass_.memory = std::move(memory);
        pass_.memory.updates.clear();
        pass_.memory.gains.clear();
        pass_.memory.gains.reserve(readings_of(drives) * size_);
    }

    FilterResult run();

private:
    double* row(std::size_t i) { return &p_[i * size_]; }
    std::size_t index(std::ptrdiff_t cell) const {
        return static_cast<std::size_t>(cell - grid_.first_cell);
    }
    std::span<const double> lags(std::ptrdiff_t cell, std::size_t side) const {
        return pass_.processes[side].lags(index(cell));
    }
    double draw(std::uint64_t what, const SampleOrder& event, std::size_t which) const {
        return counter_normal(seed_,
                              of_car(what, event.car),
                              static_cast<std::uint64_t>(drives_[event.car].first_sample) +
                                  event.sample,
                              which);
    }

    void know(std::size_t place, double sd, std::size_t car, std::size_t number);
    void start();
    Pair draw_increment(std::ptrdiff_t cell, const Increment& q);
    void append(std::ptrdiff_t cell);
    void correlate(std::ptrdiff_t cell, const Increment& q);
    void move_side(const SparseTransition& sums, std::size_t from, std::size_t to, std::size_t at);
    using Among = std::array<std::array<double, states>, states>;
    Among among_moved(const StateLayout::Car& places,
                      const std::array<SparseTransition, 2>& sides) const;
    void put_moved(const StateLayout::Car& places, const Among& among);
    void predict(const SampleOrder& event, const RoadPush& push);
    void wander(std::size_t place, double q, double drawn);
    void update(const SampleOrder& event);
    void take_in(const SampleOrder& event, std::size_t channel);

    std::span<const DriveRecord> drives_;
    const RoadGrid& grid_;
    const RoadPrior& prior_;
    std::uint64_t seed_;
    FilterResult pass_;
    std::size_t size_;
    Vector p_;     ///< covariance, size * size
    Vector moved_; ///< states * size: rows of the covariance after a step
    Vector gain_;
    Vector estimate_, error_;
};

void Filter::know(std::size_t place, double sd, std::size_t car, std::size_t number) {
    row(place)[place] = sd * sd;
    error_[place] = sd * counter_normal(seed_, of_car(for_start, car), number, 0);
}

void Filter::start() {
    for (std::size_t car = 0; car < drives_.size(); ++car) {
        const auto& places = pass_.layout.cars[car];
        for (std::size_t i = 0; i < places.states.size(); ++i) {
            know(places.first + i, start_sd(places.states[i]), car, places.states[i]);
        }
        for (std::size_t channel = 0; channel < channel_count; ++channel) {
            if (places.zero[channel] != StateLayout::nowhere) {
                know(places.zero[channel], start_zero[channel], car, states + channel);
            }
        }
        for (std::size_t pull = 0; pull < pull_count; ++pull) {
            if (places.arm[pull] != StateLayout::nowhere) {
                know(places.arm[pull], start_arm_m, car, states + channel_count + pull);
            }
        }
    }
    const Increment q = first_increment(prior_, grid_);
    const Pair w = draw_increment(grid_.first_cell, q);
    for (std::size_t side = 0; side < 2; ++side) {
        if (pass_.layout.side[side]) {
            const std::size_t at = pass_.layout.place(grid_.first_cell, side);
            row(at)[at] = side == 0 ? q.mean : q.half;
            error_[at] = side == 0 ? w.mean : w.half;
        }
    }
}

Pair Filter::draw_increment(std::ptrdiff_t cell, const Increment& q) {
    const auto key = static_cast<std::uint64_t>(cell);
    return pass_.drawn[index(cell)] = drawn_increment(
               q, counter_normal(seed_, for_road, key, 0), counter_normal(seed_, for_road, key, 1));
}

/// Adds a station to the window, in the position of the one that leaves it.
void Filter::append(std::ptrdiff_t cell) {
    const auto& layout = pass_.layout;
    const Increment& q = prior_.increments[index(cell)];
    const Pair w = draw_increment(cell, q);
    for (std::size_t side = 0; side < 2; ++side) {
        if (!layout.side[side]) {
            continue;
        }
        const std::size_t at = layout.place(cell, side);
        std::fill_n(row(at), size_, 0.0);
        estimate_[at] = 0;
        error_[at] = side == 0 ? w.mean : w.half;
        std::ptrdiff_t before = cell;
        for (const double weight : lags(cell, side)) {
            const std::size_t from = layout.place(--before, side);
            wide::add(row(at), weight, row(from), size_);
            estimate_[at] += weight * estimate_[from];
            error_[at] += weight * error_[from];
        }
    }
    correlate(cell, q);
}

/// Sets the covariances of the new elements with each other and with themselves, from the rows just
/// computed: their own columns still belong to the station that left.
void Filter::correlate(std::ptrdiff_t cell, const Increment& q) {
    const auto& layout = pass_.layout;
    const double more[2][2] = {{q.mean, q.cross}, {q.cross, q.half}};
    double among[2][2] = {};
    for (std::size_t a = 0; a < 2; ++a) {
        for (std::size_t b = 0; b < 2; ++b) {
            if (layout.side[a] && layout.side[b]) {
                const double* made = row(layout.place(cell, a));
                std::ptrdiff_t before = cell;
                for (const double weight : lags(cell, b)) {
                    among[a][b] += weight * made[layout.place(--before, b)];
                }
            }
        }
    }
    for (std::size_t a = 0; a < 2; ++a) {
        for (std::size_t b = 0; b < 2; ++b) {
            if (layout.side[a] && layout.side[b]) {
                row(layout.place(cell, a))[layout.place(cell, b)] = among[a][b] + more[a][b];
            }
        }
    }
    for (std::size_t side = 0; side < 2; ++side) {
        const std::size_t at = layout.side[side] ? layout.place(cell, side) : 0;
        for (std::size_t j = 0; j < size_ && layout.side[side]; ++j) {
            p_[j * size_ + at] = p_[at * size_ + j];
        }
    }
}

/// Computes the rows [from, to) of the car's states after the step into moved_; also estimate and
/// drawn error.
void Filter::move_side(const SparseTransition& sums,
                       std::size_t from,
                       std::size_t to,
                       std::size_t at) {
    const double* rows[SparseTransition::max_terms];
    double before[2][SparseTransition::max_terms];
    for (std::size_t k = 0; k < sums.terms; ++k) {
        rows[k] = row(sums.place[k]);
        before[0][k] = estimate_[sums.place[k]];
        before[1][k] = error_[sums.place[k]];
    }
    for (std::size_t r = from; r < to; ++r) {
        const auto& weight = sums.weight[r];
        double next[2] = {};
        for (std::size_t k = 0; k < sums.terms; ++k) {
            next[0] += weight[k] * before[0][k];
            next[1] += weight[k] * before[1][k];
        }
        estimate_[at + r] = next[0];
        error_[at + r] = next[1];
        wide::combine(&moved_[r * size_], rows, weight.data(), sums.terms, size_);
    }
}

/// Adds process noise of variance q to a random walk state.
void Filter::wander(std::size_t place, double q, double drawn) {
    row(place)[place] += q;
    error_[place] += std::sqrt(q) * drawn;
}

/// Returns the covariances among the car's states after the step, from the moved rows.
Filter::Among Filter::among_moved(const StateLayout::Car& places,
                                  const std::array<SparseTransition, 2>& sides) const {
    const std::size_t n = places.states.size();
    Among among;
    for (std::size_t r = 0; r < n; ++r) {
        for (std::size_t side = 0; side < 2; ++side) {
            const SparseTransition& sums = sides[side];
            const auto [from, to] = places.of_side(side);
            double moved[SparseTransition::max_terms];
            for (std::size_t k = 0; k < sums.terms; ++k) {
                moved[k] = moved_[r * size_ + sums.place[k]];
            }
            for (std::size_t c = std::max(from, r); c < to; ++c) {
                double total = 0;
                for (std::size_t k = 0; k < sums.terms; ++k) {
                    total += sums.weight[c][k] * moved[k];
                }
                among[r][c] = among[c][r] = total;
            }
        }
    }
    return among;
}

/// Stores the moved rows in the covariance and its columns.
void Filter::put_moved(const StateLayout::Car& places, const Among& among) {
    const std::size_t n = places.states.size();
    const std::size_t at = places.first;
    for (std::size_t r = 0; r < n; ++r) {
        std::copy_n(&moved_[r * size_], size_, row(at + r));
    }
    for (std::size_t j = 0; j < size_; ++j) {
        for (std::size_t r = 0; r < n; ++r) {
            p_[j * size_ + at + r] = moved_[r * size_ + j];
        }
    }
    for (std::size_t r = 0; r < n; ++r) {
        std::copy_n(among[r].begin(), n, row(at + r) + at);
    }
}

void Filter::predict(const SampleOrder& event, const RoadPush& push) {
    const auto& places = pass_.layout.cars[event.car];
    const DriveRecord& drive = drives_[event.car];
    const std::array sides{step_sums(0, drive, event, pass_.layout, push),
                           step_sums(1, drive, event, pass_.layout, push)};
    for (std::size_t side = 0; side < 2; ++side) {
        const auto [from, to] = places.of_side(side);
        move_side(sides[side], from, to, places.first);
    }
    put_moved(places, among_moved(places, sides));
    const double step_s = drive.cars.front().step_s;
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        if (places.zero[channel] != StateLayout::nowhere) {
            wander(places.zero[channel],
                   drive.drift[channel] * step_s,
                   draw(for_zero, event, channel));
        }
    }
    for (std::size_t pull = 0; pull < pull_count; ++pull) {
        if (places.arm[pull] != StateLayout::nowhere) {
            wander(places.arm[pull], arm_drift_m2ps * step_s, draw(for_arm, event, pull));
        }
    }
}

/// Updates the state with one channel's reading.
void Filter::take_in(const SampleOrder& event, std::size_t channel) {
    const DriveRecord& drive = drives_[event.car];
    const auto& felt = car_at(drive, event.sample).car.felt[channel];
    const auto& places = pass_.layout.cars[event.car];
    const std::size_t zero = places.zero[channel];
    const double r = drive.variance[channel][event.sample];
    std::copy_n(row(zero), size_, gain_.data());
    double seen[] = {estimate_[zero], error_[zero]};
    for (std::size_t i = 0; i < places.states.size(); ++i) {
        const double h = felt[static_cast<int>(places.states[i])];
        if (h != 0) {
            const std::size_t at = places.first + i;
            wide::add(gain_.data(), h, row(at), size_);
            seen[0] += h * estimate_[at];
            seen[1] += h * error_[at];
        }
    }
    double s = r + gain_[zero];
    for (std::size_t i = 0; i < places.states.size(); ++i) {
        s += felt[static_cast<int>(places.states[i])] * gain_[places.first + i];
    }
    const double share = 1 / s;
    const double off = drive.felt[channel][event.sample] - seen[0];
    const double noise = std::sqrt(r) * draw(for_noise, event, channel);
    const Update update{off * share, (seen[1] + noise) * share, noise};
    pass_.memory.updates.push_back(update);
    pass_.innovation.push_back(off * std::sqrt(share));
    pass_.log_variance.push_back(std::log(s));
    pass_.log_likelihood -= (std::log(s) + off * off * share) / 2;

    wide::add(estimate_.data(), update.innovation, gain_.data(), size_);
    wide::add(error_.data(), -update.error, gain_.data(), size_);
    auto& gains = pass_.memory.gains;
    const std::size_t kept = gains.size();
    gains.resize(kept + size_);
    wide::copy_times(&gains[kept], share, gain_.data(), size_);
    wide::copy_times(gain_.data(), std::sqrt(share), gain_.data(), size_);
    wide::downdate(p_.data(), gain_.data(), size_);
}

void Filter::update(const SampleOrder& event) {
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        if (!drives_[event.car].felt[channel].empty()) {
            take_in(event, channel);
        }
    }
}

FilterResult Filter::run() {
    start();
    pass_.last_cell = grid_.first_cell;
    pass_.last_before.resize(pass_.events.size());
    for (std::size_t e = 0; e < pass_.events.size(); ++e) {
        const SampleOrder& event = pass_.events[e];
        pass_.last_before[e] = pass_.last_cell;
        while (pass_.last_cell < event.last_cell) {
            append(++pass_.last_cell);
        }
        if (event.sample > 0) {
            predict(event, push_of(drives_, grid_, event));
        }
        update(event);
    }
    return std::move(pass_);
}

} // namespace

FilterResult kalman_filter(std::span<const DriveRecord> drives,
                           const RoadGrid& grid,
                           const RoadPrior& prior,
                           std::uint64_t seed,
                           SmootherMemory memory) {
    return Filter{drives, grid, prior, seed, std::move(memory)}.run();
}

} // namespace macadam
