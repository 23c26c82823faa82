#include "app/database/lock_wait_messages.hpp"

#include "app/pipeline/results_version.hpp"
#include "storage/atomic/temporary_folder.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/postgres/server_address.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/importer/server_importer.hpp"
#include "storage/store/server/replica/server_replica.hpp"

#include <fmt/format.h>

#include <string>

namespace macadam {
namespace {

void warn_of_superuser(const std::string& enough, const Console& console) {
    console.warn("connected as a superuser of the server: " + enough);
}

} // namespace

LockWaitPolicy wait_policy_for(const std::filesystem::path& store, const Console& console) {
    return {.tell =
                [store, console](const std::string& words) {
                    console.say(fmt::format("{}: {}", store.string(), words));
                },
            .stop = console.stop()};
}

StoreInfo create_store(const std::filesystem::path& store,
                       const RoadNetwork& roads,
                       const StoreSettings& settings,
                       const Console& console) {
    const auto progress = console.progress("writing segments");
    if (!is_server_address(store.string())) {
        const auto made = RoadStore::create(store, roads, settings, progress);
        cache_network(made, roads);
        return made.info();
    }
    const TemporaryFolder folder{std::filesystem::temp_directory_path() / "macadam"};
    const auto file = folder.path() / "roads.gpkg";
    const auto info = RoadStore::create(file, roads, settings, progress).info();
    warn_of_server(copy_to_server(file, store.string(), {}, console.progress("copying")),
                   store.string(),
                   console);
    return info;
}

void warn_of_server(const StoreCopy& copy, const std::string& address, const Console& console) {
    if (copy.by_superuser) {
        warn_of_superuser("a role that owns its database is enough", console);
    }
    if (copy.is_activity_open) {
        warn_of_open_activity(address, console);
    }
}

void warn_of_open_activity(const std::string& address, const Console& console) {
    console.warn(fmt::format("{}: whoever may connect sees in statistics and locks of the server "
                             "how many trips come in, and where; a superuser hides these with "
                             "'macadam privacy postgresql://SUPERUSER@HOST/DATABASE crowd'",
                             address));
}

RoadStore opened_store(const std::filesystem::path& file, const Console& console) {
    console.detail(fmt::format("opening {}", file.string()));
    if (is_server_address(file.string())) {
        return RoadStore{open_server_replica(
            file.string(), wait_policy_for(file, console), console.progress("reading drives"))};
    }
    return RoadStore::open(file, wait_policy_for(file, console));
}

ImportStore opened_for_import(const std::filesystem::path& store, const Console& console) {
    if (!is_server_address(store.string())) {
        return import_store_of(opened_store(store, console));
    }
    console.detail(fmt::format("opening {}", store.string()));
    auto open =
        open_server_import(store.string(), console.progress("fetching roads"), results_version);
    return {store, StoreReader{open.image}, open.trips, open.by_superuser};
}

void warn_of_importer(const ImportStore& store, const Console& console) {
    if (store.by_superuser) {
        warn_of_superuser("a role that was granted macadam_importer is enough", console);
    }
}

StoreReader opened_reader(const std::filesystem::path& file,
                          const Console& console,
                          Audience audience,
                          const ServerNeed& need) {
    console.detail(fmt::format("reading {}", file.string()));
    if (is_server_address(file.string())) {
        return StoreReader{open_server_reader(file.string(),
                                              need,
                                              audience,
                                              wait_policy_for(file, console),
                                              console.progress("reading drives"))};
    }
    return StoreReader::open(file, wait_policy_for(file, console), audience);
}

} // namespace macadam
