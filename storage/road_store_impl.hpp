#pragma once

#include "storage/geopackage.hpp"
#include "storage/road_store.hpp"
#include "storage/sqlite.hpp"
#include "storage/store_schema.hpp"

#include <filesystem>

namespace macadam {

struct RoadStore::Impl {
    Impl(const std::filesystem::path& file, Database::Access access) : database{file, access} {
        add_geometry_functions(database);
        check_store(database);
        settings = read_settings(database);
        if (access == Database::Access::write) { // now that it is known to be ours
            database.write_beside_readers();
        }
    }

    const ClassTable& classes() const { return *class_table(settings.class_table); }

    Database database;
    StoreSettings settings;
};

} // namespace macadam
