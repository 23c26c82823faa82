#include "app/reprocess/kept_trips.hpp"

#include "app/database/key_messages.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "estimator/common/error.hpp"
#include "storage/uploads/kept_logs.hpp"
#include "storage/uploads/upload_database.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

namespace macadam {
namespace {

namespace fs = std::filesystem;

const fs::path& expect_uploads(const fs::path& store) {
    if (!takes_uploads(store)) {
        throw InputError{
            fmt::format("{}: has no logs of a server, expected its folder {} beside it",
                        store.string(),
                        uploads_folder_of(store).filename().string())};
    }
    return store;
}

} // namespace

void erase_old_logs_of(const fs::path& store, Database& uploads, const Console& console) {
    if (kept_logs(store).empty()) {
        return;
    }
    constexpr std::int64_t ms_per_day = 86'400'000;
    const auto now_ms = std::chrono::duration_cast<std::chrono::milliseconds>(
                            std::chrono::system_clock::now().time_since_epoch())
                            .count();
    const auto reader = opened_reader(store, console, Audience::operator_);
    erase_old_logs(uploads,
                   store,
                   now_ms - reader.settings().kept_logs.days * ms_per_day,
                   [&](const std::string& trip) { return reader.contains_trip(trip); });
}

KeptTrips::KeptTrips(const fs::path& store,
                     const fs::path& key_file,
                     AskedTrips& trips,
                     const Console& console)
    : key_{read_log_key(key_file)}, folder_{uploads_folder_of(expect_uploads(store)) / "open"} {
    warn_of_open_logs_key(key_file, console);
    auto uploads = open_uploads(store, wait_policy_for(store, console));
    erase_old_logs_of(store, uploads, console);
    const auto logs = kept_logs(store);
    if (logs.empty()) {
        throw InputError{
            fmt::format("{}: keeps no log: none came, or their time is over", store.string())};
    }
    for (const auto& log : logs) {
        trips.add(log.name,
                  [this, log] { return opened_log(log.file, key_, folder_.path() / log.name); });
    }
}

TripReport KeptTrips::named(TripReport report) const {
    const auto prefix = (folder_.path() / "").string();
    const auto shorten = [&](std::string& text) {
        for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at)) {
            text.erase(at, prefix.size());
        }
    };
    shorten(report.file);
    shorten(report.error);
    for (auto& warning : report.warnings) {
        shorten(warning);
    }
    return report;
}

} // namespace macadam
