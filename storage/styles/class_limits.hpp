#pragma once

#include "mapping/style/iri_class.hpp"

#include <cstddef>
#include <string>

namespace macadam {

/// Name of a class with its limits for a legend: "fair (1.50 to 2.68 mm/m)".
std::string class_label(const ClassTable& classes, std::size_t index);

/// Lower limit of a class, mm/m; 0 for the first.
double lower_limit(const ClassTable& classes, std::size_t index);

/// Colour of a class as "215,25,28" and as "#d7191c".
std::string class_colour_numbers(const ClassTable& classes, std::size_t index);
std::string class_colour_hex(const ClassTable& classes, std::size_t index);

} // namespace macadam
