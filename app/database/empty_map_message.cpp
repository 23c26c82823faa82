#include "app/database/empty_map_message.hpp"

#include <fmt/format.h>

namespace macadam {

std::string empty_map_text(const StoreReader& store) {
    if (store.seen().first_ms) { // faster than info()
        return {};
    }
    const auto info = store.info();
    if (info.segments_with_passes > 0) {
        return {};
    }
    if (info.published_alone) {
        return "no measurements are published yet";
    }
    const auto add = fmt::format("'macadam import {} TRIPS' adds them", store.file().string());
    return info.trips == 0 ? fmt::format("no trips yet; {}", add)
                           : fmt::format("{} gave no measurement; import others: {}",
                                         info.trips == 1 ? std::string{"its only trip"}
                                                         : fmt::format("its {} trips", info.trips),
                                         add);
}

void warn_of_empty_map(const StoreReader& store, const Console& console) {
    if (const auto text = empty_map_text(store); !text.empty()) {
        console.warn(fmt::format("{}: the map is empty: {}", store.file().string(), text));
    }
}

} // namespace macadam
