#pragma once

#include "mapping/style/iri_class.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/sqlite/statement_cache.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/records/publication.hpp"
#include "storage/store/records/store_records.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace macadam {

/// Open database, shared by its reader, importer and maintenance.
struct StoreConnection {
    /// Opens a database that is an SQLite file.
    StoreConnection(const std::filesystem::path& file,
                    Database::Access access,
                    LockWaitPolicy wait_policy);

    const ClassTable& classes() const { return *class_table(settings.class_table); }

    std::int64_t segments_per_chunk() const;

    /// Checks that results may still be written: those of one network, or of own cars, must not
    /// enter another network or a crowd database.
    ///
    /// \throws InputError  if network or profile changed since the database was opened.
    void expect_same_network();

    /// Creates a new key if there is none; see TripImporter::make_missing_key().
    bool make_missing_key();

    /// Pseudonym of a car; without a key, only of "", the unknown car.
    std::string pseudonym(const std::string& vehicle_id) const;

    Database database;
    StatementCache statements{database};
    StoreSettings settings;
    std::string network_hash; ///< at the time of opening
    std::optional<PrivacyKey> key;
    bool published_alone = false; ///< see StoreReader::shows_published_alone()
};

/// Opens a database and checks that this program made it. Readers other than the operator see only
/// the latest publication of a crowd database.
///
/// \throws InputError  if it is not a road database, or its key file belongs to another one.
std::shared_ptr<StoreConnection> open_connection(const std::filesystem::path& file,
                                                 Database::Access access,
                                                 LockWaitPolicy wait_policy,
                                                 Audience audience);

} // namespace macadam
