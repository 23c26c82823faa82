#include "app/database/lock_wait_messages.hpp"

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

RoadStore opened_store(const std::filesystem::path& file,
                       RoadStore::Access access,
                       const Console& console,
                       Reader reader) {
    return RoadStore::open(file, access, wait_policy_for(file, console), reader);
}

} // namespace macadam
