#include "storage/styles/road_style.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace macadam {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 10> short_names{
    {{"trend_per_year", "trend_year"},
     {"iri_in_per_mi", "iri_inmi"},
     {"iri_sd_in_per_mi", "sd_inmi"},
     {"iri_low_in_per_mi", "low_inmi"},
     {"iri_high_in_per_mi", "high_inmi"},
     {"iri_left_in_per_mi", "left_inmi"},
     {"iri_right_in_per_mi", "right_inmi"},
     {"trend_per_year_in_per_mi", "trend_inmi"},
     {"trend_sd_in_per_mi", "trsd_inmi"},
     {"change_in_per_mi", "chng_inmi"}}};

} // namespace

std::string_view shapefile_name(std::string_view column) {
    const auto* const found = std::ranges::find(
        short_names, column, &std::pair<std::string_view, std::string_view>::first);
    return found == short_names.end() ? column : found->second;
}

std::string_view
field_name(const RoadStyle& style, std::string_view column, std::string_view unit) {
    const auto name =
        style.units == UnitSystem::us ? us_column(column, as::real(3, unit), {}).name : column;
    return style.names == FieldNames::shapefile ? shapefile_name(name) : name;
}

} // namespace macadam
