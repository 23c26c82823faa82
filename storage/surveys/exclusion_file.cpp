#include "storage/surveys/exclusion_file.hpp"

#include "estimator/common/error.hpp"
#include "storage/surveys/section_file.hpp"
#include "storage/tables/csv_table.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

constexpr double max_radius_m = 10'000;

std::vector<Exclusion> exclusions_in_table(const std::filesystem::path& file, double radius_m) {
    const auto table = read_csv_table(file);
    if (!table.has("lat_deg") || !table.has("lon_deg")) {
        throw InputError{fmt::format("{}: the header has no columns lat_deg and lon_deg, expected "
                                     "places",
                                     table.where)};
    }
    std::vector<Exclusion> exclusions;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const auto row = table.row(i);
        const auto lat_deg = row.number("lat_deg", -90, 90, "-90 to 90");
        const auto lon_deg = row.number("lon_deg", -180, 180, "-180 to 180");
        if (!lat_deg || !lon_deg) {
            throw InputError{
                fmt::format("{}: has no position, expected lat_deg and lon_deg", row.where())};
        }
        const auto own_m = row.number("radius_m", 0, max_radius_m, "0 to 10000 m, or empty");
        exclusions.push_back({{{*lat_deg, *lon_deg}}, own_m.value_or(radius_m)});
    }
    return exclusions;
}

} // namespace

std::vector<Exclusion> read_exclusions(const std::filesystem::path& file, double radius_m) {
    std::vector<Exclusion> exclusions;
    if (file.extension() == ".csv") {
        exclusions = exclusions_in_table(file, radius_m);
    } else {
        for (auto& line : read_sections(file)) {
            exclusions.push_back({std::move(line.line), radius_m});
        }
    }
    if (exclusions.empty()) {
        throw InputError{fmt::format("{}: contains no place to exclude", file.string())};
    }
    return exclusions;
}

} // namespace macadam
