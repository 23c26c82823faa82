#include "estimator/common/error.hpp"
#include "storage/store/road_store_impl.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

void expect_own_key(const PrivacyKey& key, Database& database) {
    if (key.id() != read_key_id(database)) {
        throw InputError{fmt::format(
            "{}: is not the key of {}; restore its own key, or remove this one: a new key is "
            "then made, and cars imported from then on cannot be linked to those already there",
            key_file_of(database.file()).string(),
            database.file().string())};
    }
}

} // namespace

void RoadStore::Impl::find_key() {
    key = read_key(key_file_of(database.file()));
    if (key) {
        expect_own_key(*key, database);
    }
}

bool RoadStore::Impl::make_missing_key() {
    if (key) {
        return false;
    }
    Transaction alone{database, Transaction::Kind::write}; // two imports must not create two keys
    find_key();
    if (key) {
        return false;
    }
    const auto made = PrivacyKey::make();
    put_key_id(database, made.id());
    add_last_of_key(database);
    const auto file = key_file_of(database.file());
    write_key(file, made);
    try {
        alone.commit();
    } catch (...) {
        std::error_code ignored;
        std::filesystem::remove(file, ignored);
        throw;
    }
    key = made;
    return database.number("SELECT count(*) FROM vehicle WHERE pseudonym <> 'unknown'") > 0;
}

std::string RoadStore::Impl::pseudonym(const std::string& vehicle_id) const {
    return key ? key->pseudonym(vehicle_id) : unkeyed_name_of(""); // "" is the id of no car
}

} // namespace macadam
