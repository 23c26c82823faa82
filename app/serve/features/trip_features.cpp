#include "app/serve/features/trip_features.hpp"

#include "app/query/mean_cells.hpp"
#include "storage/store/reader/trip_list.hpp"

#include <memory>
#include <vector>

namespace macadam {
namespace {

constexpr double m_in_mm = 1e-3;

// clang-format off
const Columns<StoredTrip> columns{
    {"vehicle", as::text, [](auto& r) { return r.vehicle; }},
    {"vehicle_model", as::text, [](auto& r) { return r.vehicle_model; }},
    {"method", as::text, [](auto& r) { return r.method; }},
    {"day", as::day, [](auto& r) { return day_cell(r.start_ms); }},
    {"driven_m", as::metres(0), [](auto& r) { return m_in_mm * static_cast<double>(r.driven_mm); }},
    {"matched_m", as::metres(0), [](auto& r) { return m_in_mm * static_cast<double>(r.matched_mm); }},
    {"passes", as::integer, [](auto& r) { return r.passes; }},
    {"rows_read", as::integer, [](auto& r) { return r.rows_read; }},
    {"rows_used", as::integer, [](auto& r) { return r.rows_used; }},
};
// clang-format on

} // namespace

const std::vector<FeatureColumn>& trip_feature_columns() {
    static const auto erased = feature_columns(columns);
    return erased;
}

FeatureList trip_features(const std::filesystem::path& store) {
    const auto rows = std::make_shared<const std::vector<StoredTrip>>(stored_trips(store));
    FeatureList list{{}, rows};
    for (const auto& trip : *rows) {
        list.features.push_back({.id = trip.sha256, .line = {}, .row = &trip});
    }
    return list;
}

} // namespace macadam
