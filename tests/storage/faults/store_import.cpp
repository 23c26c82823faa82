#include "store_import.hpp"

#include "storage/sqlite/sqlite.hpp"
#include "support/roads/store_world.hpp"

#include <cstdlib>

namespace macadam::testing {

void import_into(RoadStore& store, int trips, const std::function<void(int)>& acknowledged) {
    store.importer.begin_import("all", static_cast<std::size_t>(trips));
    for (int number = 0; number < trips; ++number) {
        add_trip(store, trip_record(number), passes_of(number));
        if (acknowledged) {
            acknowledged(number);
        }
        if (number % 4 == 3) { // some trips are fused while others are still to come
            store.importer.refresh();
        }
    }
    store.importer.refresh();
    store.importer.end_import("all");
}

void import_into(const std::filesystem::path& file, int trips) {
    auto store = RoadStore::open(file);
    import_into(store, trips);
}

std::string undisturbed_digest(const std::filesystem::path& empty, int trips) {
    auto file = empty;
    file += ".whole";
    std::filesystem::copy_file(empty, file, std::filesystem::copy_options::overwrite_existing);
    import_into(file, trips);
    return StoreReader::open(file).digest();
}

std::string damage_of(const std::filesystem::path& store) {
    Database database{store, Database::Access::write};
    auto check = database.prepare("PRAGMA integrity_check");
    check.step();
    return check.text(0);
}

std::size_t tries(std::size_t usual, std::size_t all) {
    return std::getenv("MACADAM_TEST_ALL") != nullptr ? all : usual;
}

} // namespace macadam::testing
