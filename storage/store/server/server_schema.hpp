#pragma once

#include "estimator/common/geo.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/postgres/server_connection.hpp"

#include <cstdint>
#include <set>
#include <string>
#include <string_view>

namespace macadam {

/// Number of the last migration that this program knows.
inline constexpr int server_schema_version = 13;

/// Creates schema `macadam` with its tables, views, comments, rights and, as far as the role may
/// create them, roles macadam_reader, macadam_importer and macadam_operator. Runs within the
/// caller's transaction.
///
/// \throws InputError  if the schema exists, or PostGIS is not installed.
void create_server_schema(ServerConnection& server);

/// Creates the partitions of cells.
void add_server_cells(ServerConnection& server, const std::set<std::int32_t>& cells);

/// Stores the style with which QGIS shows view roughness, if the role may write where QGIS looks
/// for it, in public.layer_styles.
void add_server_style(ServerConnection& server, const ClassTable& classes);

/// Statement that gives the rows of the network a new name, under which others may keep them; after
/// each change of tables way and segment.
inline constexpr const char* renew_network_rows =
    "INSERT INTO macadam.meta VALUES ('network_rows', gen_random_uuid()::text)"
    " ON CONFLICT (key) DO UPDATE SET value = excluded.value";

/// Statement that makes copies that others keep be made anew; after each change that is neither a
/// new trip nor fusion.
inline constexpr const char* renew_store_rows =
    "INSERT INTO macadam.meta VALUES ('store_rows', gen_random_uuid()::text)"
    " ON CONFLICT (key) DO UPDATE SET value = excluded.value";

/// Statement that makes copies of publications that readers keep be made anew.
inline constexpr const char* renew_published_rows =
    "INSERT INTO macadam.meta VALUES ('published_rows', gen_random_uuid()::text)"
    " ON CONFLICT (key) DO UPDATE SET value = excluded.value";

/// Names of rows of table meta that are of the server, not of the content, as SQL lists them.
inline constexpr const char* settings_of_server =
    "'format', 'version', 'network_rows', 'store_rows', 'published_rows'";

/// Schema in which PostGIS is installed, quoted.
/// \throws InputError  if it is not.
std::string postgis_schema(ServerConnection& server);

/// Checks that the server has a road database of a version that this program knows.
///
/// \throws InputError  if not.
void expect_server_schema(ServerConnection& server);

/// Runs the migrations that the schema lacks, in one transaction. Data stay as they are.
/// \returns its version before.
///
/// \throws InputError  if there is none, it is newer, or the role does not own it.
int upgrade_server_schema(ServerConnection& server);

/// Cell of a way: the map tile of zoom 8 that holds its first node, as the number of its quadkey,
/// 0 to 65,535.
std::int32_t cell_of(const GeoPoint& first_node);

/// The same from column points of table way, in which the first node comes first.
std::int32_t cell_of_way(std::string_view points);

} // namespace macadam
