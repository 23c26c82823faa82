#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/sqlite/statement_cache.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/records/publication.hpp"
#include "storage/store/records/store_records.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace macadam {

/// Open database, shared by its reader, importer and maintenance.
struct StoreConnection {
    /// Opens a database that is an SQLite file.
    ///
    /// \param known_as  name for messages, if it differs from the file name.
    StoreConnection(const std::filesystem::path& file,
                    Database::Access access,
                    LockWaitPolicy wait_policy,
                    const std::filesystem::path& known_as = {});

    const ClassTable& classes() const { return *class_table(settings.class_table); }

    std::int64_t segments_per_chunk() const;

    /// Checks that results may still be written: those of one network, or of own cars, must not
    /// enter another network or a crowd database.
    ///
    /// \throws InputError  if network or profile changed since the database was opened.
    void expect_same_network();

    /// Creates a new key if there is none; see TripImporter::make_missing_key().
    ///
    /// \throws InputError  for a copy of a database on a server, where a new key would be lost.
    bool make_missing_key();

    /// Pseudonym of a car; without a key, only of "", the unknown car.
    std::string pseudonym(const std::string& vehicle_id) const;

    /// Makes what was written durable where the user wants it: for a copy of a database on a
    /// server, there. Called at the end of each operation that writes.
    void written(const Progress& progress) {
        if (after_write) {
            after_write(progress);
        }
    }

    Database database;
    StatementCache statements{database};
    StoreSettings settings;
    std::string network_hash; ///< at the time of opening
    std::filesystem::path key_file;
    bool is_copy_of_server = false;
    std::optional<PrivacyKey> key;
    std::function<void(const Progress&)> after_write; ///< see written()
    /// Times of the first and last pass of the whole database, if this is a copy of a part of it.
    std::optional<ObservedPeriod> seen_in_whole{};
    /// Chunks that may change, and totals of all others, if this copy is made to publish.
    std::optional<PublishedPart> part_to_publish{};
    bool published_alone = false; ///< see StoreReader::shows_published_alone()
};

/// Refuses to work without the key of a database on a server.
[[noreturn]] void refuse_missing_key(const std::string& address,
                                     const std::filesystem::path& key_file);

/// Opens a database and checks that this program made it. Readers other than the operator see only
/// the latest publication of a crowd database.
///
/// \throws InputError  if it is not a road database, or its key file belongs to another one.
std::shared_ptr<StoreConnection> open_connection(const std::filesystem::path& file,
                                                 Database::Access access,
                                                 LockWaitPolicy wait_policy,
                                                 Audience audience,
                                                 const std::filesystem::path& known_as = {});

} // namespace macadam
