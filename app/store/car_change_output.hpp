#pragma once

#include "mapping/fusion/car_period.hpp"

#include <span>
#include <string>
#include <string_view>

namespace macadam {

/// Formats the changes of a car, and a scatter out of line, as lines for people; "" if there is
/// neither.
/// \param car  name or number with which the lines begin
std::string changes_text(std::string_view car, std::span<const CarPeriod> periods);

/// Formats the changes as a JSON array, oldest first.
std::string changes_json(std::span<const CarPeriod> periods);

} // namespace macadam
