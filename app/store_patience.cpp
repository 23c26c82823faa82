#include "app/store_patience.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace macadam {

LockPatience
patience_for(const std::filesystem::path& store, const Console& console, std::stop_token stop) {
    return {.tell =
                [store, console](const std::string& words) {
                    console.say(fmt::format("{}: {}", store.string(), words));
                },
            .stop = std::move(stop)};
}

} // namespace macadam
