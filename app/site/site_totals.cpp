#include "app/site/site_totals.hpp"

#include "storage/store/rows/segment_row.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace macadam {
namespace {

constexpr double bin_mm_per_m = 0.25;
constexpr int last_bin = 47; // from 11.75 mm/m on

int passes_step(std::int32_t passes) {
    constexpr std::array begins{2, 5, 10};
    return static_cast<int>(
        std::ranges::count_if(begins, [&](int begin) { return passes >= begin; }));
}

/// Returns 0 for an interval of at most 15 % to either side, 1 up to 30 %, 2 beyond.
int confidence_step(const SegmentState& state) {
    const auto half_um = 0.5 * static_cast<double>(state.high_um - state.low_um);
    const auto iri_um = static_cast<double>(state.iri_um);
    return half_um <= 0.15 * iri_um ? 0 : half_um <= 0.3 * iri_um ? 1 : 2;
}

} // namespace

void SiteTotals::add(const SegmentRecord& record) {
    const auto& state = *record.state;
    const double iri = mm_per_m(state.iri_um);
    const Cell cell{record.highway,
                    {static_cast<int>(class_index(*classes_, iri)),
                     passes_step(state.passes),
                     confidence_step(state),
                     std::clamp(static_cast<int>(iri / bin_mm_per_m), 0, last_bin)}};
    length_m_[cell] += record.segment.to_m - record.segment.from_m;
}

std::vector<std::string> SiteTotals::highways() const {
    std::vector<std::string> names;
    for (const auto& [cell, length_m] : length_m_) {
        if (names.empty() || names.back() != cell.highway) {
            names.push_back(cell.highway);
        }
    }
    return names;
}

double SiteTotals::km() const {
    double total_m = 0;
    for (const auto& [cell, length_m] : length_m_) {
        total_m += length_m;
    }
    return total_m / 1000;
}

std::string SiteTotals::json() const {
    const auto names = highways();
    std::vector<std::string> rows;
    for (const auto& [cell, length_m] : length_m_) {
        const auto highway = std::ranges::lower_bound(names, cell.highway) - names.begin();
        const auto& [in_class, passes, confidence, bin] = cell.numbers;
        rows.push_back(fmt::format("[{},{},{},{},{},{:.4f}]",
                                   in_class,
                                   highway,
                                   passes,
                                   confidence,
                                   bin,
                                   length_m / 1000));
    }
    return JsonObject{}
        .add("bin_mm_per_m", JsonNumber{bin_mm_per_m, 2})
        .add("rows", JsonRaw{json_array(rows)})
        .text();
}

} // namespace macadam
