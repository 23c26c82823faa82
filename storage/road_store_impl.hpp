#pragma once

#include "storage/geopackage.hpp"
#include "storage/kept_statements.hpp"
#include "storage/road_store.hpp"
#include "storage/row_visit.hpp"
#include "storage/sqlite.hpp"
#include "storage/store_schema.hpp"

#include <filesystem>
#include <string>
#include <utility>

namespace macadam {

struct RoadStore::Impl {
    Impl(const std::filesystem::path& file, Database::Access access, LockPatience patience)
        : database{file, access, {}, std::move(patience)} {
        add_geometry_functions(database);
        add_row_visits(database);
        check_store(database);
        settings = read_settings(database);
        network_hash = read_network_hash(database);
        if (access == Database::Access::write) { // now that it is known to be ours
            database.write_beside_readers();
        }
    }

    const ClassTable& classes() const { return *class_table(settings.class_table); }

    /// What was worked out for one network cannot be written into another.
    /// \throws InputError  if the network was updated since the store was opened.
    void expect_same_network();

    Database database;
    KeptStatements statements{database};
    StoreSettings settings;
    std::string network_hash; ///< as it was when the store was opened
};

} // namespace macadam
