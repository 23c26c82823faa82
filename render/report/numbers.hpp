#pragma once

#include "mapping/iri_class.hpp"
#include "mapping/road_mean.hpp"

#include <cstddef>
#include <string>

namespace macadam {

// Numbers as the report writes them. All give HTML.

/// "12&#8239;345": thousands parted by narrow blanks from five digits on.
std::string count_text(std::size_t count);

/// Kilometres of road with the decimals that fit the longest of them: 2 below 10 km, 1 below
/// 1000 km, then none.
std::string km_text(double length_m, double longest_m);

/// "34.1 %"; "0 %" only for nothing, "&lt; 0.1 %" for hardly anything. A dash of nothing.
std::string percent_text(double part, double whole);

/// "2.41".
std::string iri_text(double iri_mm_per_m);

/// "2.11 – 2.71": the 90 % interval.
std::string interval_text(const RoadMean& mean);

/// What a class reaches from and to, in mm/m or in/mi: "below 1.50", "1.50 – 2.68".
std::string range_text(const ClassTable& table, std::size_t i, bool in_per_mi);

} // namespace macadam
