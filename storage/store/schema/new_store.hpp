#pragma once

#include "estimator/common/geo.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/records/privacy_profile.hpp"

#include <functional>
#include <string>

namespace macadam {

/// Creates the tables of a road database, has `fill` fill all but those of the GeoPackage itself,
/// and indexes them afterwards, in one transaction.
///
/// \param fill  returns the box around all segments.
/// \throws InputError  for an unknown class table.
void fill_new_store(Database& database,
                    const std::string& class_table_name,
                    PrivacyProfile privacy,
                    const std::function<GeoBox()>& fill);

/// Creates the indexes of tables that are filled before.
void index_store_tables(Database& database);

} // namespace macadam
