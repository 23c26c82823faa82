#include "storage/store/road_store.hpp"

#include "storage/atomic/atomic_file_set.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/copy/file_copy.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <system_error>
#include <utility>

namespace macadam {

RoadStore RoadStore::create(const std::filesystem::path& file,
                            const RoadNetwork& roads,
                            const StoreSettings& settings,
                            const Progress& progress) {
    expect_new_file(file);
    const auto key_file = key_file_of(file);
    const auto old_key = read_key(key_file);
    const auto key = old_key.value_or(PrivacyKey::make());
    AtomicFileSet whole{file};
    Database database{whole.main_file(), Database::Access::create, file};
    add_geometry_functions(database);
    write_store(database, roads, settings, key.id(), progress);
    database.close();
    remove_leftovers_of(file);
    if (!old_key) {
        write_key(key_file, key);
    }
    try {
        whole.commit_new();
    } catch (...) {
        std::error_code ignored;
        if (!old_key && !std::filesystem::exists(file, ignored)) {
            std::filesystem::remove(key_file, ignored);
        }
        throw;
    }
    return open(file);
}

RoadStore RoadStore::open(const std::filesystem::path& file, LockWaitPolicy wait_policy) {
    return RoadStore{open_connection(
        file, Database::Access::write, std::move(wait_policy), Audience::operator_)};
}

} // namespace macadam
