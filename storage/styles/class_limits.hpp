#pragma once

#include "storage/styles/road_style.hpp"

#include <cstddef>
#include <string>

namespace macadam {

/// Name of a class with its limits for a legend: "fair (1.50 to 2.68 mm/m)", "fair (95 to 170
/// in/mi)".
std::string class_label(const RoadStyle& style, std::size_t index);

/// Converts an IRI to the units of the style.
double in_units_of(const RoadStyle& style, double mm_per_m);

/// Limits of a class in the units of the style; the lower one of the first is 0, the upper one of
/// the last infinite.
double lower_limit(const RoadStyle& style, std::size_t index);
double upper_limit(const RoadStyle& style, std::size_t index);

/// Colour of a class as "215,25,28" and as "#d7191c".
std::string class_colour_numbers(const ClassTable& classes, std::size_t index);
std::string class_colour_hex(const ClassTable& classes, std::size_t index);

} // namespace macadam
