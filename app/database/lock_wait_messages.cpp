#include "app/database/lock_wait_messages.hpp"

#include "storage/postgres/server_address.hpp"
#include "storage/store/server/store_copy.hpp"

#include <fmt/format.h>

#include <string>

namespace macadam {

LockWaitPolicy wait_policy_for(const std::filesystem::path& store, const Console& console) {
    return {.tell =
                [store, console](const std::string& words) {
                    console.say(fmt::format("{}: {}", store.string(), words));
                },
            .stop = console.stop()};
}

RoadStore opened_store(const std::filesystem::path& file, const Console& console) {
    console.detail(fmt::format("opening {}", file.string()));
    return RoadStore::open(file, wait_policy_for(file, console));
}

StoreReader
opened_reader(const std::filesystem::path& file, const Console& console, Audience audience) {
    console.detail(fmt::format("reading {}", file.string()));
    if (is_server_address(file.string())) {
        return StoreReader{open_server_moment(
            file.string(), wait_policy_for(file, console), console.progress("reading drives"))};
    }
    return StoreReader::open(file, wait_policy_for(file, console), audience);
}

} // namespace macadam
