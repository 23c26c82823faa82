#include "storage/store/schema/store_versions.hpp"

#include "storage/store/schema/schema_sql.hpp"

#include <fmt/format.h>

#include <string_view>

namespace macadam {
namespace {

/// Returns the definition before version 3, which stores days in place of times.
std::string with_times(std::string sql) {
    constexpr std::string_view day = " DATE";
    constexpr std::string_view time = " DATETIME";
    for (std::size_t at = 0; (at = sql.find(day, at)) != std::string::npos; at += time.size()) {
        sql.replace(at, day.size(), time);
    }
    return sql;
}

/// Returns the definition of table trip before version 7.
std::string without_trimmed_column(std::string sql) {
    const auto column = fmt::format(", {}", trimmed_column);
    return sql.erase(sql.find(column), column.size());
}

} // namespace

Schema schema_of_version(int version, PrivacyProfile privacy) {
    // Before version 5, the layer of every database had all fused values.
    auto schema = own_schema(version <= 4 ? PrivacyProfile::own : privacy);
    if (version <= 6) {
        auto& trip = schema.at({"table", "trip"});
        trip.sql = without_trimmed_column(trip.sql);
    }
    if (version <= 2) {
        auto& state = schema.at({"table", "segment_state"});
        state.sql = with_times(state.sql);
    }
    return schema;
}

} // namespace macadam
