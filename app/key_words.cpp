#include "app/key_words.hpp"

#include <fmt/format.h>

namespace macadam {

void warn_of_open_key(const RoadStore& store, const Console& console) {
    const auto file = key_file_of(store.file());
    if (store.is_operator() && is_open_to_others(file)) {
        console.warn(fmt::format("{}: others can read it, and with it tell which cars are in the "
                                 "store; 'chmod 600' closes it",
                                 file.string()));
    }
}

void make_missing_key(RoadStore& store, const Console& console) {
    if (store.make_missing_key()) {
        console.warn(fmt::format("{}: was not there, and a new key was made; cars that come from "
                                 "now on cannot be joined to those that are in the store",
                                 key_file_of(store.file()).string()));
    }
    warn_of_open_key(store, console);
}

} // namespace macadam
