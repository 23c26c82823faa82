#include "storage/trips/foreign/axes.hpp"

#include <cstdlib>

namespace macadam {

TripRow in_vehicle_axes(TripRow row, const std::array<int, 3>& axes) {
    for (const auto x : {TripColumn::acc_x, TripColumn::gyro_x}) {
        const auto first = static_cast<std::size_t>(x);
        const std::array<double, 3> old{
            row.value[first], row.value[first + 1], row.value[first + 2]};
        for (std::size_t i = 0; i < 3; ++i) {
            const auto from = static_cast<std::size_t>(std::abs(axes[i]) - 1);
            row.value[first + i] = axes[i] < 0 ? -old[from] : old[from];
        }
    }
    return row;
}

} // namespace macadam
