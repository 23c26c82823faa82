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

/// A feature table or view of lines in WGS 84, as a GeoPackage lists it. The names are ours, never
/// those of a user: they stand in SQL as they are.
struct FeatureLayer {
    std::string_view table;
    std::string_view title;
    std::string_view description;
    GeoBox box;
};

/// The tables that make an empty SQLite file a GeoPackage 1.3.
void make_geopackage(Database& database);

/// Lists a table or view whose geometry column is `geom`.
void list_features(Database& database, const FeatureLayer& layer);

/// Fills an R-tree for the table's `geom`, whose key is `fid`, and adds the triggers that keep it.
/// Of a database that is being created.
void index_features(Database& database, std::string_view table);

/// Those triggers alone. A database that may be anybody's lets no trigger write an R-tree, so who
/// changes rows takes them away, keeps the R-tree himself, and puts them back.
void add_index_triggers(Database& database, std::string_view table);
void remove_index_triggers(Database& database, std::string_view table);

} // namespace macadam
