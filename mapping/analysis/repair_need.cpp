#include "mapping/analysis/repair_need.hpp"

#include "mapping/analysis/network_summary.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace macadam {

double traffic_weight(std::string_view highway) {
    constexpr std::array<std::pair<std::string_view, double>, 8> weights{{{"motorway", 4},
                                                                          {"trunk", 4},
                                                                          {"primary", 4},
                                                                          {"secondary", 3},
                                                                          {"tertiary", 2},
                                                                          {"service", 0.5},
                                                                          {"track", 0.5},
                                                                          {"other", 0.5}}};
    const auto kind = road_kind(highway);
    const auto* const found =
        std::ranges::find(weights, kind, [](const auto& weight) { return weight.first; });
    return found == weights.end() ? 1 : found->second;
}

RepairNeed repair_need(const WorstSection& section, double above_mm_per_m) {
    const double weight = traffic_weight(section.highway) * section.mean.length_m;
    return {.certain = weight * std::max(0.0, section.mean.low - above_mm_per_m),
            .expected = weight * (section.mean.iri - above_mm_per_m)};
}

void sort_by_need(std::vector<WorstSection>& sections, double above_mm_per_m) {
    std::ranges::stable_sort(sections, [&](const WorstSection& a, const WorstSection& b) {
        const auto of_a = repair_need(a, above_mm_per_m);
        const auto of_b = repair_need(b, above_mm_per_m);
        return std::pair{of_a.certain, of_a.expected} > std::pair{of_b.certain, of_b.expected};
    });
}

} // namespace macadam
