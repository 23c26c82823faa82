#pragma once

#include "mapping/analysis/worst_sections.hpp"

#include <string_view>
#include <vector>

namespace macadam {

/// Weight of a road's traffic: a convention, by OSM's class of the road. Motorway to primary 4,
/// secondary 3, tertiary 2, service roads, tracks and unknown classes 1/2, all other roads 1. Slip
/// roads count with their road.
double traffic_weight(std::string_view highway);

/// Need of repair of a section, mm: its measured length times its roughness above the border of
/// poor, times the weight of its traffic.
struct RepairNeed {
    double certain;  ///< of the lower end of the 90 % interval, at least 0
    double expected; ///< of the mean
};

RepairNeed repair_need(const WorstSection& section, double above_mm_per_m);

/// Sorts sections by their certain need, those without any by their expected need, the greatest
/// first. A road that was passed once has a wide interval, and so hardly a certain need.
void sort_by_need(std::vector<WorstSection>& sections, double above_mm_per_m);

} // namespace macadam
