#pragma once

#include "storage/geopackage/geopackage.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/sqlite/row_callback.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/sqlite/statement_cache.hpp"
#include "storage/store/publication/publication_rows.hpp"
#include "storage/store/road_store.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace macadam {

struct RoadStore::Impl {
    Impl(const std::filesystem::path& file, Database::Access access, LockWaitPolicy wait_policy)
        : database{file, access, {}, std::move(wait_policy)} {
        add_geometry_functions(database);
        register_row_callback(database);
        check_store(database);
        settings = read_settings(database);
        network_hash = read_network_hash(database);
        find_key();
        if (access == Database::Access::write) { // after check_store()
            database.enable_wal();
        }
    }

    const ClassTable& classes() const { return *class_table(settings.class_table); }

    /// Checks that results may still be written: those of one network, or of own cars, must not
    /// enter another network or a crowd database.
    ///
    /// \throws InputError  if network or profile changed since the database was opened.
    void expect_same_network();

    /// Reads the key beside the database, if any.
    ///
    /// \throws InputError  if it belongs to another database.
    void find_key();

    /// See RoadStore::make_missing_key().
    bool make_missing_key();

    /// Pseudonym of a car; without a key, only of "", the unknown car.
    std::string pseudonym(const std::string& vehicle_id) const;

    void show_published_alone() {
        macadam::show_published_alone(database);
        published_alone = true;
    }

    Database database;
    StatementCache statements{database};
    StoreSettings settings;
    std::string network_hash; ///< at the time of opening
    std::optional<PrivacyKey> key;
    bool published_alone = false; ///< see RoadStore::shows_published_alone()
};

} // namespace macadam
