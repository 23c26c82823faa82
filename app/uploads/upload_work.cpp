#include "app/uploads/upload_work.hpp"

#include "app/database/lock_wait_messages.hpp"
#include "app/import/import_run.hpp"
#include "app/import/trip_options.hpp"
#include "app/jobs/log_outcome.hpp"
#include "app/reprocess/kept_trips.hpp"
#include "estimator/common/error.hpp"
#include "storage/store/road_store.hpp"
#include "storage/uploads/kept_logs.hpp"
#include "storage/uploads/upload_database.hpp"
#include "storage/uploads/upload_queue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using Result = TripReport::Result;

/// Logs that are imported together: fusing takes as long for one as for many.
constexpr std::size_t batch_size = 20;
constexpr int max_attempts = 50; // by UploadWork::running_since, in three hours at least

/// Notes what became of one trip of an upload.
void note(Database& uploads,
          const std::function<bool(const std::string&)>& is_stored,
          const TakenUpload& taken,
          const TripReport& report,
          const fs::path& file,
          LogOutcome& outcome) {
    const auto& upload = taken.upload();
    // A trip that is stored, after an attempt that a kill ended, and of which nobody else says that
    // it is his, was imported by that attempt.
    const bool is_our_own =
        report.result == Result::known && (is_trip_of(uploads, upload, report.sha256) ||
                                           (upload.attempts > 1 && is_stored(report.sha256) &&
                                            !is_trip_of_any(uploads, report.sha256)));
    add(outcome, report, file, is_our_own);
    if (report.result == Result::imported || is_our_own) {
        add_trip_of(uploads, upload, report.sha256, static_cast<std::int64_t>(report.passes));
    }
}

/// Tests whether all trips of a log were imported from it: then it can be kept, as it goes with any
/// of them. With others, it would outlast what their owners delete.
bool are_all_ours(const LogOutcome& outcome) {
    return outcome.imported > 0 && outcome.imported == outcome.trips();
}

/// Keeps the log of an upload whose trips are stored: if that fails, they are still its trips.
void keep(const UploadWork& work,
          const Upload& upload,
          const LogKeeping& kept,
          const Console& console) {
    try {
        keep_log(work.store, upload, kept.public_key);
    } catch (const InputError& error) {
        console.warn(fmt::format("{}; the log was imported, but is not kept", error.what()));
    }
}

/// Returns how often a log may have been begun that is tried now.
int max_begun(const UploadWork& work) {
    constexpr int at_once = 1;
    constexpr std::chrono::seconds pause{10};
    return work.running_since
               ? at_once + static_cast<int>(
                               (std::chrono::steady_clock::now() - *work.running_since) / pause)
               : std::numeric_limits<int>::max();
}

bool import_batch(Database& uploads, const UploadWork& work, const Console& console) {
    const auto spool = spool_of(work.store);
    const auto taken = take_uploads(uploads, spool, batch_size, max_begun(work));
    if (taken.empty()) {
        return false;
    }
    if (const auto& first = taken.front().upload(); first.attempts > max_attempts) { // it is alone
        finish_upload(uploads,
                      spool,
                      first,
                      UploadState::refused,
                      fmt::format("the import ended {} times at this log", max_attempts));
        return true;
    }
    std::vector<fs::path> files;
    std::vector<LogOutcome> outcomes(taken.size());
    LogKeeping kept;
    for (const auto& one : taken) {
        files.push_back(one.upload().file_in(spool));
    }
    try {
        VehicleChoice vehicles{work.arguments};
        auto store = opened_store(work.store, console);
        kept = store.settings().kept_logs;
        auto options = parse_import(work.arguments);
        options.named_after = spool;
        const auto is_stored = [&](const std::string& trip) { // other threads use `store`
            return opened_reader(work.store, console, Audience::operator_).contains_trip(trip);
        };
        options.tell = [&](const TripReport& report) {
            for (std::size_t i = 0; i < taken.size(); ++i) {
                if (is_of(report, files[i])) {
                    note(uploads, is_stored, taken[i], report, files[i], outcomes[i]);
                }
            }
            if (work.tell) {
                work.tell(report);
            }
        };
        auto target = import_store_of(store);
        import_paths(target, files, options, vehicles, console);
    } catch (...) {
        for (const auto& one : taken) {
            put_back(uploads, one.upload());
        }
        throw;
    }
    for (std::size_t i = 0; i < taken.size(); ++i) {
        const auto fate = fate_of(outcomes[i]);
        if (kept.days > 0 && are_all_ours(outcomes[i])) {
            keep(work, taken[i].upload(), kept, console);
        }
        finish_upload(uploads, spool, taken[i].upload(), fate.state, fate.reason);
    }
    return true;
}

/// Forgets the trips of one deleted upload. \returns false if there is none.
bool forget_one(Database& uploads, const UploadWork& work, const Console& console) {
    const auto deletion = next_deletion(uploads);
    if (!deletion) {
        return false;
    }
    auto store = opened_store(work.store, console);
    ForgetRequest request;
    std::ranges::copy_if(deletion->trips, std::back_inserter(request.trips), [&](const auto& trip) {
        return store.contains_trip(trip);
    });
    if (!request.trips.empty()) {
        store.maintenance.forget(request, console.progress("deleting"));
    }
    erase_kept_log(work.store, deletion->upload);
    finish_deletion(uploads, deletion->upload);
    return true;
}

} // namespace

Arguments upload_arguments(std::vector<std::string> words) {
    static constexpr auto options = trip_options_and(std::array{trim_option});
    return {options, {}, std::move(words)};
}

bool work_out_uploads(Database& uploads, const UploadWork& work, const Console& console) {
    return forget_one(uploads, work, console) || import_batch(uploads, work, console);
}

void work_out_all_uploads(const fs::path& store, const Console& console) {
    if (!takes_uploads(store)) {
        return;
    }
    auto uploads = open_uploads(store, wait_policy_for(store, console));
    const UploadWork work{.store = store, .arguments = upload_arguments({})};
    bool has_said = false;
    while (count_waiting(uploads) > 0) {
        if (console.stop().stop_requested()) {
            throw InputError{fmt::format("{}: interrupted while trips were waiting; nothing was "
                                         "changed",
                                         store.string())};
        }
        if (!std::exchange(has_said, true)) {
            console.say("importing the trips that a server has received, first");
        }
        // Its workers know the vehicle files; ours need not.
        if (WorkerMark::is_set(spool_of(store)) || !work_out_uploads(uploads, work, console)) {
            std::this_thread::sleep_for(std::chrono::milliseconds{200});
        }
    }
}

void drop_forgotten_uploads(const StoreReader& store, const Console& console) {
    if (takes_uploads(store.file())) {
        auto uploads = open_uploads(store.file());
        erase_old_logs_of(store.file(), uploads, console); // first, as it asks for their trips
        drop_missing_trips(uploads,
                           [&](const std::string& trip) { return store.contains_trip(trip); });
    }
}

} // namespace macadam
