#include "estimator/smoother/filter/sparse_transition.hpp"

namespace macadam {
namespace {

constexpr auto heaves = static_cast<std::size_t>(LinearCar::heave_states);

} // namespace

SparseTransition step_sums(std::size_t side,
                           const DriveRecord& drive,
                           const SampleOrder& event,
                           const StateLayout& layout,
                           const RoadPush& push) {
    const CarSteps& steps = car_at(drive, event.sample);
    const auto& places = layout.cars[event.car];
    const std::size_t from = places.of_side(side).first;
    const std::size_t to = places.of_side(side).second;
    SparseTransition sums;
    const auto add = [&](std::size_t place, auto weight) {
        sums.place[sums.terms] = place;
        for (std::size_t r = from; r < to; ++r) {
            sums.weight[r][sums.terms] = weight(places.states[r]);
        }
        ++sums.terms;
    };
    for (std::size_t c = from; c < to; ++c) {
        const auto column = static_cast<int>(places.states[c]);
        add(places.first + c,
            [&](std::size_t r) { return steps.phi(static_cast<int>(r), column); });
    }
    for (const auto& axle : push.axles) {
        for (std::size_t i = 0; i < axle.cells && from < to; ++i) {
            if (!places.has_rear && &axle == &push.axles[1]) {
                continue;
            }
            add(layout.place(axle.first + static_cast<std::ptrdiff_t>(i), side),
                [&](std::size_t r) {
                    return side == 0 ? axle.heave[i][r] : axle.roll[i][r - heaves];
                });
        }
    }
    const std::size_t pull = side; // braking dips, cornering rolls
    if (from < to && places.arm[pull] != StateLayout::nowhere) {
        const double pulled = drive.pull[pull][event.sample];
        add(places.arm[pull], [&](std::size_t r) {
            return steps.lean(static_cast<int>(r), static_cast<int>(pull)) * pulled;
        });
    }
    return sums;
}

} // namespace macadam
