#include "storage/trips/positions/position_columns.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>

namespace macadam {

void expect_positions_to_do(const TripNeeds& needs,
                            const std::string& name,
                            std::string_view what) {
    const auto missing = missing_measurements(needs, is_position_column);
    if (!missing.empty()) {
        throw InputError{fmt::format(
            "{}: is {}, which has positions only, expected also {}", name, what, missing)};
    }
}

} // namespace macadam
