#include "app/database/key_messages.hpp"

#include <fmt/format.h>

namespace macadam {

void warn_of_open_key(const StoreReader& store, const Console& console) {
    const auto file = key_file_of(store.file());
    if (store.is_operator() && is_open_to_others(file)) {
        console.warn(fmt::format("{}: other users can read this key and identify the cars in "
                                 "the database; run 'chmod 600' on it",
                                 file.string()));
    }
}

void make_missing_key(RoadStore& store, const Console& console) {
    if (store.importer.make_missing_key()) {
        console.warn(fmt::format("{}: was missing, so a new key was made; cars imported from "
                                 "now on cannot be linked to those already in the database",
                                 key_file_of(store.file()).string()));
    }
    warn_of_open_key(store, console);
}

} // namespace macadam
