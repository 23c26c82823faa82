#include "app/store_patience.hpp"

#include <fmt/format.h>

#include <string>

namespace macadam {

LockPatience patience_for(const std::filesystem::path& store, const Console& console) {
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
    return RoadStore::open(file, access, patience_for(file, console), reader);
}

} // namespace macadam
