#include "storage/store/connection/store_connection.hpp"

#include "estimator/common/error.hpp"
#include "mapping/passes/chunk_trace.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/sqlite/row_callback.hpp"
#include "storage/sqlite/sqlite_header_check.hpp"
#include "storage/store/publication/publication_rows.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace macadam {
namespace {

/// Reads the key beside a database, if any.
///
/// \throws InputError  if it belongs to another database.
std::optional<PrivacyKey> read_own_key(Database& database, const std::filesystem::path& file) {
    auto key = read_key(file);
    if (key && key->id() != read_key_id(database)) {
        throw InputError{fmt::format(
            "{}: is not the key of {}; restore its own key, or remove this one: a new key is "
            "then made, and cars imported from then on cannot be linked to those already there",
            file.string(),
            database.file().string())};
    }
    return key;
}

} // namespace

StoreConnection::StoreConnection(const std::filesystem::path& file,
                                 Database::Access access,
                                 LockWaitPolicy wait_policy,
                                 const std::filesystem::path& known_as)
    : database{file, access, known_as, std::move(wait_policy)}, key_file{key_file_of(file)} {
    add_geometry_functions(database);
    register_row_callback(database);
    check_store(database);
    settings = read_settings(database);
    network_hash = read_network_hash(database);
    key = read_own_key(database, key_file);
    if (access == Database::Access::write) { // after check_store()
        database.enable_wal();
    }
}

std::int64_t StoreConnection::segments_per_chunk() const {
    return macadam::segments_per_chunk(settings.segment_length_m);
}

void StoreConnection::expect_same_network() {
    if (read_network_hash(database) != network_hash) {
        throw InputError{fmt::format("{}: its roads were updated in the meantime; nothing was "
                                     "written, run the command again",
                                     database.file().string())};
    }
    if (read_settings(database).privacy != settings.privacy) {
        throw InputError{fmt::format("{}: became a crowd database in the meantime; nothing was "
                                     "written, run the command again",
                                     database.file().string())};
    }
}

bool StoreConnection::make_missing_key() {
    if (key) {
        return false;
    }
    if (is_copy_of_server) {
        refuse_missing_key(database.file().string(), key_file);
    }
    Transaction alone{database, Transaction::Kind::write}; // two imports must not create two keys
    key = read_own_key(database, key_file);
    if (key) {
        return false;
    }
    const auto made = PrivacyKey::make();
    put_key_id(database, made.id());
    add_last_of_key(database);
    write_key(key_file, made);
    try {
        alone.commit();
    } catch (...) {
        std::error_code ignored;
        std::filesystem::remove(key_file, ignored);
        throw;
    }
    key = made;
    return database.number("SELECT count(*) FROM vehicle WHERE pseudonym <> 'unknown'") > 0;
}

std::string StoreConnection::pseudonym(const std::string& vehicle_id) const {
    return key ? key->pseudonym(vehicle_id) : unkeyed_name_of(""); // "" is the id of no car
}

void refuse_missing_key(const std::string& address, const std::filesystem::path& key_file) {
    throw InputError{fmt::format("{}: the key of its cars is not at {}; copy it there from a "
                                 "computer that imports into this database",
                                 address,
                                 key_file.string())};
}

std::shared_ptr<StoreConnection> open_connection(const std::filesystem::path& file,
                                                 Database::Access access,
                                                 LockWaitPolicy wait_policy,
                                                 Audience audience,
                                                 const std::filesystem::path& known_as) {
    expect_store_file(file);
    auto store = std::make_shared<StoreConnection>(file, access, std::move(wait_policy), known_as);
    const bool sees_all = audience == Audience::operator_ && store->key;
    if (store->settings.privacy == PrivacyProfile::crowd && access == Database::Access::read &&
        !sees_all) {
        show_published_alone(store->database);
        store->published_alone = true;
    }
    return store;
}

} // namespace macadam
