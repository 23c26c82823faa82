#include "estimator/smoother/filter/forward_backward.hpp"

#include <algorithm>

namespace macadam {
namespace {

using Vector = std::vector<double>;

constexpr auto heaves = static_cast<std::size_t>(LinearCar::heave_states);

/// Backward recursion of de Jong's r, for the estimate and for the drawn error.
class Smoother {
public:
    Smoother(std::span<const DriveRecord> drives,
             const RoadGrid& grid,
             const RoadPrior& prior,
             const FilterResult& forward)
        : drives_{drives}, grid_{grid}, prior_{prior}, forward_{forward}, layout_{forward.layout},
          next_{forward.memory.updates.size()}, r_{Vector(layout_.size), Vector(layout_.size)} {
        road_.increment_m.resize(grid.cells);
        road_.perturbed_m.resize(grid.cells);
        for (const auto& drive : drives) {
            auto& residual = road_.residual.emplace_back();
            for (std::size_t channel = 0; channel < channel_count; ++channel) {
                residual[channel].seen.resize(drive.felt[channel].size());
                residual[channel].open.resize(drive.felt[channel].size());
            }
        }
    }

    SmoothedRoad run();

private:
    void over_update(const SampleOrder& event);
    void over_step(const SampleOrder& event, const RoadPush& push, Vector& r) const;
    void leave(std::ptrdiff_t cell);
    Pair disturbance(std::ptrdiff_t cell, const Increment& q, Vector& r) const;

    std::span<const DriveRecord> drives_;
    const RoadGrid& grid_;
    const RoadPrior& prior_;
    const FilterResult& forward_;
    const StateLayout& layout_;
    std::size_t next_; ///< index of the next update, from the last
    std::array<Vector, 2> r_;
    SmoothedRoad road_;
};

void Smoother::over_update(const SampleOrder& event) {
    const DriveRecord& drive = drives_[event.car];
    const auto& places = layout_.cars[event.car];
    for (std::size_t channel = channel_count; channel-- > 0;) {
        if (drive.felt[channel].empty()) {
            continue;
        }
        const auto& felt = car_at(drive, event.sample).car.felt[channel];
        const Update& update = forward_.memory.updates[--next_];
        const double* gain = &forward_.memory.gains[next_ * layout_.size];
        const double variance = drive.variance[channel][event.sample];
        double noise[2]; // smoothed
        for (std::size_t column = 0; column < 2; ++column) {
            Vector& r = r_[column];
            double along = 0;
            for (std::size_t j = 0; j < layout_.size; ++j) {
                along += gain[j] * r[j];
            }
            const double by = (column == 0 ? update.innovation : update.error) - along;
            for (std::size_t i = 0; i < places.states.size(); ++i) {
                r[places.first + i] += felt[static_cast<int>(places.states[i])] * by;
            }
            r[places.zero[channel]] += by;
            noise[column] = variance * by;
        }
        const double open = update.noise - noise[1];
        auto& residual = road_.residual[event.car][channel];
        residual.seen[event.sample] = static_cast<float>(noise[0] * noise[0] / variance);
        residual.open[event.sample] = static_cast<float>(open * open / variance);
    }
}

void Smoother::over_step(const SampleOrder& event, const RoadPush& push, Vector& r) const {
    const CarSteps& steps = car_at(drives_[event.car], event.sample);
    const auto& places = layout_.cars[event.car];
    const std::size_t n = places.states.size();
    std::array<double, LinearCar::states> after;
    std::copy_n(&r[places.first], n, after.begin());
    for (std::size_t c = 0; c < n; ++c) {
        double before = 0;
        for (std::size_t i = 0; i < n; ++i) {
            before +=
                steps.phi(static_cast<int>(places.states[i]), static_cast<int>(places.states[c])) *
                after[i];
        }
        r[places.first + c] = before;
    }
    for (const auto& axle : push.axles) {
        for (std::size_t cell = 0; cell < axle.cells; ++cell) {
            double onto[2] = {};
            for (std::size_t i = 0; i < n; ++i) {
                const std::size_t state = places.states[i];
                onto[state < heaves ? 0 : 1] +=
                    after[i] *
                    (state < heaves ? axle.heave[cell][state] : axle.roll[cell][state - heaves]);
            }
            for (std::size_t side = 0; side < 2; ++side) {
                if (layout_.side[side]) {
                    r[layout_.place(axle.first + static_cast<std::ptrdiff_t>(cell), side)] +=
                        onto[side];
                }
            }
        }
    }
    for (std::size_t pull = 0; pull < pull_count; ++pull) {
        if (places.arm[pull] != StateLayout::nowhere) {
            double onto = 0;
            for (std::size_t i = 0; i < n; ++i) {
                onto += steps.lean(static_cast<int>(places.states[i]), static_cast<int>(pull)) *
                        after[i];
            }
            r[places.arm[pull]] += onto * drives_[event.car].pull[pull][event.sample];
        }
    }
}

/// Returns the smoothed increment of a station and removes the station from the window.
Pair Smoother::disturbance(std::ptrdiff_t cell, const Increment& q, Vector& r) const {
    const auto index = static_cast<std::size_t>(cell - grid_.first_cell);
    double at_station[2] = {};
    for (std::size_t side = 0; side < 2; ++side) {
        if (layout_.side[side]) {
            double& at = r[layout_.place(cell, side)];
            at_station[side] = at;
            at = 0;
            std::ptrdiff_t before = cell;
            for (const double weight : forward_.processes[side].lags(index)) {
                r[layout_.place(--before, side)] += weight * at_station[side];
            }
        }
    }
    return {q.mean * at_station[0] + q.cross * at_station[1],
            q.cross * at_station[0] + q.half * at_station[1]};
}

void Smoother::leave(std::ptrdiff_t cell) {
    const auto index = static_cast<std::size_t>(cell - grid_.first_cell);
    const Increment q = index == 0 ? first_increment(prior_, grid_) : prior_.increments[index];
    const Pair& drawn = forward_.drawn[index];
    road_.increment_m[index] = disturbance(cell, q, r_[0]);
    const Pair explained = disturbance(cell, q, r_[1]);
    road_.perturbed_m[index] = {drawn.mean - explained.mean, drawn.half - explained.half};
}

SmoothedRoad Smoother::run() {
    std::ptrdiff_t last_cell = forward_.last_cell;
    for (std::size_t e = forward_.events.size(); e-- > 0;) {
        const SampleOrder& event = forward_.events[e];
        over_update(event);
        if (event.sample > 0) {
            const auto push = push_of(drives_, grid_, event);
            over_step(event, push, r_[0]);
            over_step(event, push, r_[1]);
        }
        for (; last_cell > forward_.last_before[e]; --last_cell) {
            leave(last_cell);
        }
    }
    leave(last_cell);
    return std::move(road_);
}

} // namespace

SmoothedRoad disturbance_smoother(std::span<const DriveRecord> drives,
                                  const RoadGrid& grid,
                                  const RoadPrior& prior,
                                  const FilterResult& forward) {
    return Smoother{drives, grid, prior, forward}.run();
}

} // namespace macadam
