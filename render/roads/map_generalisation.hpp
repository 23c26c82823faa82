#pragma once

#include "render/roads/line_joining.hpp"
#include "render/scene/scene.hpp"

#include <vector>

namespace macadam {

/// Tells whether a map shows a road: measured ones always, others down to a scale by rank. Service
/// roads are shown down to 1:50,000, residential ones to 1:150,000, tertiary to 1:400,000,
/// secondary to 1:1,000,000.
///
/// \param scale_denominator  25000 for 1:25,000
bool is_shown(const MapLine& line, double scale_denominator);

/// Tells whether a map names roads of a rank: motorways and main roads down to 1:300,000, secondary
/// ones to 1:100,000, tertiary to 1:75,000, residential to 1:50,000, service to 1:15,000.
bool is_named(int rank, double scale_denominator);

/// Length on paper below which a change of class is not drawn.
inline constexpr double min_run_mm = 1.5;

/// Gives runs of one class along a road that are shorter than `min_run_m` the class of the run that
/// they form with the neighbour nearest in IRI, as join_short_runs of vector tiles does: that of
/// the length-weighted mean IRI, or without IRI that of the longer run. Whether it is certain or
/// has few passes is taken from the longer run.
///
/// \param uses   lines of the roads as drawn; others are unchanged
/// \param table  of the lines' classes
void join_short_classes(std::vector<MapLine>& lines,
                        const std::vector<LineUse>& uses,
                        const ClassTable& table,
                        double min_run_m);

} // namespace macadam
