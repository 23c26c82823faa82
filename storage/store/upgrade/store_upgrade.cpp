#include "storage/store/upgrade/store_upgrade.hpp"

#include "estimator/common/error.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/geopackage/hidden_tables.hpp"
#include "storage/sqlite/sqlite_header_check.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/rows/audit.hpp"
#include "storage/store/rows/store_digest.hpp"
#include "storage/store/schema/schema_check.hpp"
#include "storage/store/schema/store_schema.hpp"
#include "storage/store/schema/store_versions.hpp"
#include "storage/store/upgrade/upgrade_steps.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <system_error>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr int first_version_with_key = 3;
constexpr int first_version_with_trimmed_lengths = 7;

/// Checks the free disk space: new rows are written beside the old ones, and the journal holds the
/// pages of both.
void expect_room(Database& database) {
    constexpr std::int64_t state_bytes = 600; // 200 per row, three times
    constexpr std::int64_t trip_bytes = 400;
    constexpr std::int64_t other_bytes = 4 << 20;
    const auto needed = static_cast<std::uintmax_t>(
        database.number("SELECT count(*) FROM segment_state") * state_bytes +
        database.number("SELECT count(*) FROM trip") * trip_bytes + other_bytes);
    std::error_code error;
    const auto room = fs::space(fs::absolute(database.file()).parent_path(), error);
    if (!error && room.available < needed) {
        throw InputError{fmt::format("{}: the disk has {} MB left, expected {} MB for the new "
                                     "rows beside the old ones; the database is unchanged",
                                     database.file().string(),
                                     room.available >> 20U,
                                     (needed >> 20U) + 1)};
    }
}

void expect_sound(Database& database) {
    auto check = database.prepare("PRAGMA quick_check(1)");
    if (check.step() && check.text(0) != "ok") {
        throw InputError{fmt::format("{}: is damaged: {}; the database is unchanged",
                                     database.file().string(),
                                     check.text(0))};
    }
}

/// Computes the digest and reports it as finished.
std::string digest_told(Database& database, const Progress& progress) {
    auto digest = digest_of(database, progress);
    progress(1, 1);
    return digest;
}

void expect_same_digest(Database& database, const std::string& before, const std::string& after) {
    if (after != before) {
        throw InputError{fmt::format("{}: its digest would change from {} to {}; the database "
                                     "is unchanged",
                                     database.file().string(),
                                     before,
                                     after)};
    }
}

/// Key file that is removed again unless kept.
class NewKey {
public:
    explicit NewKey(const fs::path& database) : file_{key_file_of(database)} {
        const auto old = read_key(file_);
        key_ = old.value_or(PrivacyKey::make());
        if (!old) {
            write_key(file_, key());
            is_new_ = goes_ = true;
        }
    }
    NewKey(const NewKey&) = delete;
    NewKey& operator=(const NewKey&) = delete;
    ~NewKey() {
        if (goes_) {
            std::error_code ignored;
            fs::remove(file_, ignored);
        }
    }

    void keep() { goes_ = false; }
    const PrivacyKey& key() const { return *key_; }
    bool is_new() const { return is_new_; }

private:
    fs::path file_;
    std::optional<PrivacyKey> key_;
    bool is_new_ = false;
    bool goes_ = false;
};

/// \returns the version of the database. \throws InputError  if this program did not make it.
int expect_known(Database& database) {
    const auto found = read_schema(database);
    const int version = expect_store(database, found);
    expect_no_foreign_object(
        database, found, schema_of_version(version, claimed_privacy(database)));
    return version;
}

} // namespace

StoreUpgrade upgrade_store(const fs::path& file,
                           const LockWaitPolicy& wait_policy,
                           const UpgradeProgress& progress) {
    expect_store_file(file);
    Database database{file, Database::Access::write};
    database.set_lock_wait(wait_policy);
    add_geometry_functions(database);
    const ForeignKeysOff keys_stay_as_they_are{database};
    StoreUpgrade done{.from_version = expect_known(database), .to_version = store_version};
    if (done.from_version == store_version) {
        check_store(database);
        return done;
    }
    expect_room(database);

    Transaction all{database, Transaction::Kind::write};
    if (expect_known(database) != done.from_version) {
        throw InputError{
            fmt::format("{}: another command upgraded it in the meantime", file.string())};
    }
    expect_sound(database);
    done.digest = digest_told(database, progress("computing the digest"));
    std::optional<NewKey> key;
    if (done.from_version < first_version_with_key) {
        key.emplace(file);
        done.made_key = key->is_new();
        make_days(database, progress("rounding times to days"));
        done.trips = shorten_trip_names(database, progress("removing vehicle ids from file names"));
        done.cars = name_cars(database, key->key());
        put_settings_of_version_3(database, key->key().id());
    }
    if (done.from_version < first_version_with_trimmed_lengths) {
        add_trimmed_lengths(database);
    }
    add_missing_objects(database);
    replace_roughness_layer(database, claimed_privacy(database));
    hide_other_tables(database);
    put_version(database);
    add_audit(database,
              "upgrade",
              fmt::format("from version {} to {}", done.from_version, store_version));
    expect_same_digest(
        database, done.digest, digest_told(database, progress("verifying the digest")));
    check_store(database);
    if (key) {
        key->keep(); // even if the commit is in doubt: the next upgrade uses it
    }
    all.commit();
    return done;
}

} // namespace macadam
