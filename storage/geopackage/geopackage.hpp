#pragma once

#include "estimator/common/geo.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

inline constexpr std::int64_t geopackage_application_id = 1196444487; ///< "GPKG"
inline constexpr std::int64_t geopackage_user_version = 10300;        ///< 1.3.0

/// Feature table or view of lines or points in WGS 84, as listed in a GeoPackage. Names are
/// inserted into SQL unquoted and must never come from a user.
struct FeatureLayer {
    std::string_view table;
    std::string_view title;
    std::string_view description;
    GeoBox box;
    std::string_view geometry = "LINESTRING";
};

/// Creates the tables that turn an empty SQLite file into a GeoPackage 1.3.
void make_geopackage(Database& database);

/// Registers a table or view whose geometry column is `geom`.
void list_features(Database& database, const FeatureLayer& layer);

/// Fills an R-tree for the column `geom` of a table with the key `fid`, and adds the triggers that
/// maintain it. For a database that is being created.
void index_features(Database& database, std::string_view table);

/// Adds only those triggers. SQLite does not let triggers of an untrusted database write an R-tree,
/// so code that changes rows removes the triggers, updates the R-tree itself, and adds them again.
void add_index_triggers(Database& database, std::string_view table);
void remove_index_triggers(Database& database, std::string_view table);

} // namespace macadam
