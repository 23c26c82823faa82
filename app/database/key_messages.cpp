#include "app/database/key_messages.hpp"

#include <fmt/format.h>

namespace macadam {

namespace {

void warn_if_open(const std::filesystem::path& key_file, const Console& console) {
    if (is_open_to_others(key_file)) {
        console.warn(fmt::format("{}: other users can read this key and identify the cars in "
                                 "the database; run 'chmod 600' on it",
                                 key_file.string()));
    }
}

} // namespace

void warn_of_open_key(const StoreReader& store, const Console& console) {
    if (store.is_operator()) {
        warn_if_open(store.key_file(), console);
    }
}

void warn_of_open_logs_key(const std::filesystem::path& key_file, const Console& console) {
    if (is_open_to_others(key_file)) {
        console.warn(fmt::format("{}: other users can read this key, and with it the logs that the "
                                 "server keeps; run 'chmod 600' on it",
                                 key_file.string()));
    }
}

void make_missing_key(ImportTarget& trips, const Console& console) {
    if (trips.make_missing_key()) {
        console.warn(fmt::format("{}: was missing, so a new key was made; cars imported from "
                                 "now on cannot be linked to those already in the database",
                                 trips.key_file().string()));
    }
    warn_if_open(trips.key_file(), console);
}

} // namespace macadam
