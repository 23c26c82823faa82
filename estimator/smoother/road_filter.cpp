#include "estimator/smoother/road_filter.hpp"

#include "estimator/smoother/normal_draw.hpp"
#include "estimator/smoother/wide.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace macadam {
namespace {

using Vector = std::vector<double>;

constexpr std::size_t states = LinearCar::states;
constexpr std::size_t heaves = LinearCar::heave_states;
constexpr std::size_t block = states + channel_count; // of a car: its states and its zeros
constexpr std::size_t most_terms = states + 2 * RoadPush::most_cells;

// What is known of a car before anything is felt; start-up forgets it.
constexpr double start_m = 0.05;
constexpr double start_mps = 0.3;
constexpr double start_rad = 0.03;
constexpr double start_radps = 0.2;
constexpr std::array<double, channel_count> start_zero{1, 1, 0.1, 0.1}; // m/s^2, rad/s

// What a number is drawn for.
constexpr std::uint64_t for_start = 1;
constexpr std::uint64_t for_road = 2;
constexpr std::uint64_t for_zero = 3;
constexpr std::uint64_t for_noise = 4;

std::uint64_t of_car(std::uint64_t what, std::size_t car) {
    return what + 8 * car;
}

/// A sample of a car.
struct Event {
    std::size_t car, sample;
    double front_m;           ///< where the front axle is
    std::ptrdiff_t last_cell; ///< that must be there: the one ahead of it
};

std::vector<Event> events_of(std::span<const Passage> passages, double cell_m) {
    std::vector<Event> events;
    for (std::size_t car = 0; car < passages.size(); ++car) {
        const auto& passage = passages[car];
        for (std::size_t k = 0; k < passage.travel_m.size(); ++k) {
            const double front_m = passage.travel_m[k] + passage.cars.front().car.front_m;
            events.push_back(
                {car, k, front_m, static_cast<std::ptrdiff_t>(std::floor(front_m / cell_m)) + 1});
        }
    }
    std::ranges::stable_sort(events, {}, &Event::front_m);
    return events;
}

/// Stations that must be held at once: under the longest car and what it drives in a step.
std::size_t window_of(std::span<const Passage> passages, double cell_m) {
    double longest_m = 0;
    for (const auto& passage : passages) {
        double step_m = 0;
        for (std::size_t k = 1; k < passage.travel_m.size(); ++k) {
            step_m = std::max(step_m, passage.travel_m[k] - passage.travel_m[k - 1]);
        }
        const auto& car = passage.cars.front().car;
        longest_m = std::max(longest_m, car.front_m - car.rear_m + step_m);
    }
    return static_cast<std::size_t>(std::ceil(longest_m / cell_m)) + 3;
}

/// One number of the state as a sum of others.
struct Sum {
    std::size_t terms = 0;
    std::array<std::size_t, most_terms> place{};
    std::array<double, most_terms> weight{};

    void add(std::size_t at, double by) {
        place[terms] = at;
        weight[terms++] = by;
    }
};

/// The two columns of numbers that go through the filter: the estimate, and the error of a road and
/// readings that are drawn.
struct Columns {
    Vector estimate, error;
};

struct Update {
    double share;      ///< 1 / S
    double innovation; ///< e / S of the estimate, ...
    double error;      ///< ... and of the drawn error
};

class Filter {
public:
    Filter(std::span<const Passage> passages,
           const RoadGrid& grid,
           const RoadPrior& prior,
           std::uint64_t seed)
        : passages_{passages}, grid_{grid}, prior_{prior}, seed_{seed},
          mean_keep_{std::exp(-grid.cell_m / prior.mean_length_m)},
          half_keep_{std::exp(-grid.cell_m / prior.half_length_m)}, window_{window_of(passages,
                                                                                      grid.cell_m)},
          road_at_{passages.size() * block}, size_{road_at_ + 2 * window_}, p_(size_ * size_),
          moved_(states * size_), gain_(size_), column_{Vector(size_), Vector(size_)},
          drawn_(grid.cells) {}

    SmoothedRoad run();

private:
    std::size_t slot(std::ptrdiff_t cell) const {
        return road_at_ + 2 * (static_cast<std::size_t>(cell - grid_.first_cell) % window_);
    }
    std::size_t index(std::ptrdiff_t cell) const {
        return static_cast<std::size_t>(cell - grid_.first_cell);
    }
    double* row(std::size_t i) { return &p_[i * size_]; }

    Increment start_of_road() const;
    void start();
    void append(std::ptrdiff_t cell);
    void append_to_columns(std::ptrdiff_t cell,
                           const Increment& q,
                           double mean_keep,
                           double half_keep,
                           std::size_t from);
    Sum sum_for(std::size_t state, const Event& event, const RoadPush& push) const;
    void predict(const Event& event, const RoadPush& push);
    void update(const Event& event, SmoothedRoad& road);

    std::array<Pair, 2> disturbance(std::ptrdiff_t cell);
    void back_over_update(const Event& event, std::size_t& next);
    void back_over_step(const Event& event, const RoadPush& push, Vector& r) const;
    std::vector<Pair> profile_of(const std::vector<Pair>& increments) const;

    std::span<const Passage> passages_;
    const RoadGrid& grid_;
    const RoadPrior& prior_;
    std::uint64_t seed_;
    double mean_keep_, half_keep_; ///< of an elevation, from a station to the next
    std::size_t window_, road_at_, size_;
    Vector p_;     ///< covariance, size * size
    Vector moved_; ///< states * size: rows of it after a step
    Vector gain_;
    Columns column_;
    std::vector<Pair> drawn_; ///< increments of the drawn road
    std::vector<Update> updates_;
    Vector gains_;               ///< of the updates, size each
    std::array<Vector, 2> back_; ///< of the two columns, going backward
};

Increment Filter::start_of_road() const {
    const Increment& q = prior_.increments.front();
    return {q.mean / (1 - mean_keep_ * mean_keep_), q.half / (1 - half_keep_ * half_keep_), 0};
}

void Filter::start() {
    for (std::size_t car = 0; car < passages_.size(); ++car) {
        for (std::size_t i = 0; i < block; ++i) {
            const bool angle = i == 2 || i == 3 || i == 8 || i == 9;
            const double sd = i >= states  ? start_zero[i - states]
                              : i % 2 == 0 ? (angle ? start_rad : start_m)
                                           : (angle ? start_radps : start_mps);
            const std::size_t at = car * block + i;
            row(at)[at] = sd * sd;
            column_.error[at] = sd * normal_draw(seed_, of_car(for_start, car), i, 0);
        }
    }
    const Increment q = start_of_road();
    const std::size_t at = slot(grid_.first_cell);
    row(at)[at] = q.mean;
    row(at + 1)[at + 1] = q.half;
    append_to_columns(grid_.first_cell, q, 0, 0, at);
}

void Filter::append_to_columns(
    std::ptrdiff_t cell, const Increment& q, double mean_keep, double half_keep, std::size_t from) {
    const auto key = static_cast<std::uint64_t>(cell);
    const double mean_sd = std::sqrt(q.mean);
    const double along = q.cross / mean_sd;
    const double one = normal_draw(seed_, for_road, key, 0);
    const double two = normal_draw(seed_, for_road, key, 1);
    const Pair w{mean_sd * one,
                 along * one + std::sqrt(std::max(q.half - along * along, 0.0)) * two};
    drawn_[index(cell)] = w;
    const std::size_t at = slot(cell);
    column_.estimate[at] = mean_keep * column_.estimate[from];
    column_.estimate[at + 1] = half_keep * column_.estimate[from + 1];
    column_.error[at] = mean_keep * column_.error[from] + w.mean;
    column_.error[at + 1] = half_keep * column_.error[from + 1] + w.half;
}

/// A station comes into the window, in the place of the one that leaves it.
void Filter::append(std::ptrdiff_t cell) {
    const std::size_t at = slot(cell);
    const std::size_t from = slot(cell - 1);
    const Increment& q = prior_.increments[index(cell)];
    const double keep[] = {mean_keep_, half_keep_};
    for (std::size_t side = 0; side < 2; ++side) {
        wide::copy_times(row(at + side), keep[side], row(from + side), size_);
    }
    for (std::size_t side = 0; side < 2; ++side) {
        for (std::size_t j = 0; j < size_; ++j) {
            p_[j * size_ + at + side] = p_[(at + side) * size_ + j];
        }
    }
    const auto among = [&](std::size_t a, std::size_t b) {
        return keep[a] * keep[b] * row(from + a)[from + b];
    };
    row(at)[at] = among(0, 0) + q.mean;
    row(at)[at + 1] = row(at + 1)[at] = among(0, 1) + q.cross;
    row(at + 1)[at + 1] = among(1, 1) + q.half;
    append_to_columns(cell, q, mean_keep_, half_keep_, from);
}

/// A state of the car after the step, from states and stations before it.
Sum Filter::sum_for(std::size_t state, const Event& event, const RoadPush& push) const {
    const auto& phi = car_at(passages_[event.car], event.sample).phi;
    const bool heave = state < heaves;
    Sum sum;
    for (std::size_t c = heave ? 0 : heaves; c < (heave ? heaves : states); ++c) {
        sum.add(event.car * block + c, phi(static_cast<int>(state), static_cast<int>(c)));
    }
    for (const auto& axle : push.axles) {
        for (std::size_t i = 0; i < axle.cells; ++i) {
            const std::size_t place = slot(axle.first + static_cast<std::ptrdiff_t>(i));
            sum.add(place + (heave ? 0 : 1),
                    heave ? axle.heave[i][state] : axle.roll[i][state - heaves]);
        }
    }
    return sum;
}

void Filter::predict(const Event& event, const RoadPush& push) {
    const std::size_t at = event.car * block;
    std::array<Sum, states> sums;
    double next[2][states];
    for (std::size_t r = 0; r < states; ++r) {
        sums[r] = sum_for(r, event, push);
        const Sum& sum = sums[r];
        const double* rows[most_terms];
        next[0][r] = next[1][r] = 0;
        for (std::size_t k = 0; k < sum.terms; ++k) {
            rows[k] = row(sum.place[k]);
            next[0][r] += sum.weight[k] * column_.estimate[sum.place[k]];
            next[1][r] += sum.weight[k] * column_.error[sum.place[k]];
        }
        wide::combine(&moved_[r * size_], rows, sum.weight.data(), sum.terms, size_);
    }
    double among[states][states];
    for (std::size_t c = 0; c < states; ++c) {
        for (std::size_t r = 0; r <= c; ++r) {
            double total = 0;
            for (std::size_t k = 0; k < sums[c].terms; ++k) {
                total += sums[c].weight[k] * moved_[r * size_ + sums[c].place[k]];
            }
            among[r][c] = among[c][r] = total;
        }
    }
    for (std::size_t r = 0; r < states; ++r) {
        std::copy_n(&moved_[r * size_], size_, row(at + r));
        column_.estimate[at + r] = next[0][r];
        column_.error[at + r] = next[1][r];
    }
    for (std::size_t j = 0; j < size_; ++j) {
        for (std::size_t r = 0; r < states; ++r) {
            p_[j * size_ + at + r] = moved_[r * size_ + j];
        }
    }
    for (std::size_t r = 0; r < states; ++r) {
        std::copy_n(among[r], states, row(at + r) + at);
    }
    const Passage& passage = passages_[event.car];
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        const std::size_t zero = at + states + channel;
        const double q = passage.drift[channel] * passage.cars.front().step_s;
        row(zero)[zero] += q;
        column_.error[zero] +=
            std::sqrt(q) *
            normal_draw(seed_,
                        of_car(for_zero, event.car),
                        static_cast<std::uint64_t>(passage.first_sample) + event.sample,
                        channel);
    }
}

/// Takes in what the channels felt, one after the other.
void Filter::update(const Event& event, SmoothedRoad& road) {
    const Passage& passage = passages_[event.car];
    const auto& felt = car_at(passage, event.sample).car.felt;
    const std::size_t at = event.car * block;
    for (std::size_t channel = 0; channel < channel_count; ++channel) {
        if (passage.felt[channel].empty()) {
            continue;
        }
        const std::size_t zero = at + states + channel;
        const double r = passage.variance[channel][event.sample];
        std::copy_n(row(zero), size_, gain_.data());
        double seen[] = {column_.estimate[zero], column_.error[zero]};
        for (std::size_t i = 0; i < states; ++i) {
            const double h = felt[channel][static_cast<int>(i)];
            if (h != 0) {
                wide::add(gain_.data(), h, row(at + i), size_);
                seen[0] += h * column_.estimate[at + i];
                seen[1] += h * column_.error[at + i];
            }
        }
        double s = r + gain_[zero];
        for (std::size_t i = 0; i < states; ++i) {
            s += felt[channel][static_cast<int>(i)] * gain_[at + i];
        }
        const double share = 1 / s;
        const double off = passage.felt[channel][event.sample] - seen[0];
        const double noise =
            std::sqrt(r) *
            normal_draw(seed_,
                        of_car(for_noise, event.car),
                        static_cast<std::uint64_t>(passage.first_sample) + event.sample,
                        channel);
        const Update update{share, off * share, (seen[1] + noise) * share};
        updates_.push_back(update);
        road.innovation.push_back(off * std::sqrt(share));
        road.log_variance.push_back(-std::log(share));
        road.log_likelihood -= (std::log(s) + off * off * share) / 2;

        wide::add(column_.estimate.data(), update.innovation, gain_.data(), size_);
        wide::add(column_.error.data(), -update.error, gain_.data(), size_);
        const std::size_t kept = gains_.size();
        gains_.resize(kept + size_);
        wide::copy_times(&gains_[kept], share, gain_.data(), size_);
        wide::copy_times(gain_.data(), std::sqrt(share), gain_.data(), size_);
        wide::downdate(p_.data(), gain_.data(), size_);
    }
}

/// The smoothed increment of a station, of both columns, and out of the window with it.
std::array<Pair, 2> Filter::disturbance(std::ptrdiff_t cell) {
    const bool first = cell == grid_.first_cell;
    const Increment q = first ? start_of_road() : prior_.increments[index(cell)];
    const std::size_t at = slot(cell);
    std::array<Pair, 2> increments;
    for (std::size_t column = 0; column < 2; ++column) {
        Vector& r = back_[column];
        const double mean = r[at];
        const double half = r[at + 1];
        increments[column] = {q.mean * mean + q.cross * half, q.cross * mean + q.half * half};
        r[at] = r[at + 1] = 0;
        if (!first) {
            const std::size_t from = slot(cell - 1);
            r[from] += mean_keep_ * mean;
            r[from + 1] += half_keep_ * half;
        }
    }
    return increments;
}

void Filter::back_over_update(const Event& event, std::size_t& next) {
    const Passage& passage = passages_[event.car];
    const auto& felt = car_at(passage, event.sample).car.felt;
    const std::size_t at = event.car * block;
    for (std::size_t channel = channel_count; channel-- > 0;) {
        if (passage.felt[channel].empty()) {
            continue;
        }
        const Update& update = updates_[--next];
        const double* gain = &gains_[next * size_];
        const double innovations[] = {update.innovation, update.error};
        for (std::size_t column = 0; column < 2; ++column) {
            Vector& r = back_[column];
            double along = 0;
            for (std::size_t j = 0; j < size_; ++j) {
                along += gain[j] * r[j];
            }
            const double by = innovations[column] - along;
            for (std::size_t i = 0; i < states; ++i) {
                r[at + i] += felt[channel][static_cast<int>(i)] * by;
            }
            r[at + states + channel] += by;
        }
    }
}

void Filter::back_over_step(const Event& event, const RoadPush& push, Vector& r) const {
    const auto& phi = car_at(passages_[event.car], event.sample).phi;
    const std::size_t at = event.car * block;
    CarState after;
    for (std::size_t i = 0; i < states; ++i) {
        after[static_cast<int>(i)] = r[at + i];
    }
    const CarState before = phi.transpose() * after;
    for (std::size_t i = 0; i < states; ++i) {
        r[at + i] = before[static_cast<int>(i)];
    }
    for (const auto& axle : push.axles) {
        for (std::size_t i = 0; i < axle.cells; ++i) {
            const std::size_t place = slot(axle.first + static_cast<std::ptrdiff_t>(i));
            for (std::size_t j = 0; j < heaves; ++j) {
                r[place] += axle.heave[i][j] * after[static_cast<int>(j)];
            }
            for (std::size_t j = heaves; j < states; ++j) {
                r[place + 1] += axle.roll[i][j - heaves] * after[static_cast<int>(j)];
            }
        }
    }
}

std::vector<Pair> Filter::profile_of(const std::vector<Pair>& increments) const {
    std::vector<Pair> profile(increments.size());
    Pair at;
    for (std::size_t i = 0; i < increments.size(); ++i) {
        at = {mean_keep_ * at.mean + increments[i].mean, half_keep_ * at.half + increments[i].half};
        profile[i] = at;
    }
    return profile;
}

SmoothedRoad Filter::run() {
    const auto events = events_of(passages_, grid_.cell_m);
    SmoothedRoad road;
    road.increment_m.resize(grid_.cells);
    road.perturbed_m.resize(grid_.cells);

    start();
    std::ptrdiff_t last_cell = grid_.first_cell;
    std::vector<std::ptrdiff_t> last_before(events.size());
    std::vector<RoadPush> pushes(events.size());
    for (std::size_t e = 0; e < events.size(); ++e) {
        const Event& event = events[e];
        last_before[e] = last_cell;
        while (last_cell < event.last_cell) {
            append(++last_cell);
        }
        if (event.sample > 0) {
            const auto& travel_m = passages_[event.car].travel_m;
            const double from_m = travel_m[event.sample - 1];
            pushes[e] = road_push(car_at(passages_[event.car], event.sample),
                                  from_m,
                                  travel_m[event.sample] - from_m,
                                  grid_.cell_m);
            predict(event, pushes[e]);
        }
        update(event, road);
    }

    back_ = {Vector(size_), Vector(size_)};
    const auto leave = [&](std::ptrdiff_t cell) {
        const auto increments = disturbance(cell);
        const Pair& drawn = drawn_[index(cell)];
        road.increment_m[index(cell)] = increments[0];
        road.perturbed_m[index(cell)] = {drawn.mean - increments[1].mean,
                                         drawn.half - increments[1].half};
    };
    std::size_t next = updates_.size();
    for (std::size_t e = events.size(); e-- > 0;) {
        back_over_update(events[e], next);
        if (events[e].sample > 0) {
            back_over_step(events[e], pushes[e], back_[0]);
            back_over_step(events[e], pushes[e], back_[1]);
        }
        for (; last_cell > last_before[e]; --last_cell) {
            leave(last_cell);
        }
    }
    leave(last_cell);
    road.profile_m = profile_of(road.increment_m);
    road.perturbation_m = profile_of(road.perturbed_m);
    return road;
}

} // namespace

const CarSteps& car_at(const Passage& passage, std::size_t sample) {
    return passage.cars[passage.which.empty() ? 0 : passage.which[sample]];
}

RoadGrid grid_under(std::span<const Passage> passages, double cell_m) {
    constexpr auto far = std::numeric_limits<double>::infinity();
    double from_m = far;
    double to_m = -far;
    for (const auto& passage : passages) {
        const auto& car = passage.cars.front().car;
        from_m = std::min(from_m, passage.travel_m.front() + car.rear_m);
        to_m = std::max(to_m, passage.travel_m.back() + car.front_m);
    }
    const auto first = static_cast<std::ptrdiff_t>(std::floor((std::floor(from_m) - 1) / cell_m));
    const auto last = static_cast<std::ptrdiff_t>(std::floor(to_m / cell_m)) + 2;
    return {cell_m, first, static_cast<std::size_t>(last - first + 1)};
}

SmoothedRoad smooth_road(std::span<const Passage> passages,
                         const RoadGrid& grid,
                         const RoadPrior& prior,
                         std::uint64_t seed) {
    return Filter{passages, grid, prior, seed}.run();
}

std::vector<CarState>
ride_over(const Passage& passage, const RoadGrid& grid, std::span<const Pair> road_m) {
    const auto at = [&](std::ptrdiff_t cell) -> const Pair& {
        return road_m[static_cast<std::size_t>(cell - grid.first_cell)];
    };
    CarState x = CarState::Zero();
    const auto& car = passage.cars.front().car;
    const double under_m = at(static_cast<std::ptrdiff_t>(std::floor(
                                  (passage.travel_m.front() + car.rear_m) / grid.cell_m)))
                               .mean;
    x[0] = x[4] = x[6] = under_m; // heave and wheels
    std::vector<CarState> states_{x};
    states_.reserve(passage.travel_m.size());
    for (std::size_t k = 1; k < passage.travel_m.size(); ++k) {
        const auto& steps = car_at(passage, k);
        const double from_m = passage.travel_m[k - 1];
        const auto push = road_push(steps, from_m, passage.travel_m[k] - from_m, grid.cell_m);
        x = steps.phi * x;
        for (const auto& axle : push.axles) {
            for (std::size_t i = 0; i < axle.cells; ++i) {
                const Pair& road = at(axle.first + static_cast<std::ptrdiff_t>(i));
                for (std::size_t j = 0; j < heaves; ++j) {
                    x[static_cast<int>(j)] += axle.heave[i][j] * road.mean;
                }
                for (std::size_t j = heaves; j < states; ++j) {
                    x[static_cast<int>(j)] += axle.roll[i][j - heaves] * road.half;
                }
            }
        }
        states_.push_back(x);
    }
    return states_;
}

} // namespace macadam
