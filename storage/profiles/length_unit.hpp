#pragma once

#include <optional>
#include <string_view>

namespace macadam {

/// Metres in a unit of length as profile files abbreviate them (m, mm, in, ft, mil, ...), whatever
/// its case; of a word that was cut off after 8 characters, too. Nothing for any other unit.
std::optional<double> metres_in(std::string_view unit);

} // namespace macadam
