#include "app/jobs/job_worker.hpp"

#include "app/database/key_messages.hpp"
#include "app/database/lock_wait_messages.hpp"
#include "app/import/import_run.hpp"
#include "app/jobs/deleted_logs.hpp"
#include "app/jobs/job_batch.hpp"
#include "app/jobs/job_options.hpp"
#include "app/jobs/worker_heartbeat.hpp"
#include "app/pipeline/results_version.hpp"
#include "estimator/common/error.hpp"
#include "storage/atomic/temporary_folder.hpp"
#include "storage/jobs/announced_logs.hpp"
#include "storage/jobs/sent_logs.hpp"
#include "storage/jobs/worker_register.hpp"
#include "storage/objects/object_store.hpp"
#include "storage/postgres/idle_limit.hpp"
#include "storage/store/server/cells/cell_drives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <stop_token>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto look_every = 1s; // with jitter: a NOTIFY would make commits wait for each other
constexpr auto after_trouble = 5s;
constexpr auto max_objects_pause = 60s;
constexpr auto upkeep_every = 60s;
constexpr auto fuse_at_age = 45s;
constexpr std::chrono::seconds max_fusing = 60s;
constexpr std::size_t max_batch = 100;
constexpr std::size_t max_erased = 20; // in one transaction: who submits one of them again waits

/// Folder for fetched logs; removes those that killed workers of this user left.
fs::path swept_temporary_name() {
    auto name = fs::temp_directory_path() / "macadam-worker";
    for (const auto& leftover : leftovers_of(name)) {
        std::error_code not_ours;
        fs::remove_all(leftover.name, not_ours);
    }
    return name;
}

/// The object store cannot be reached, whatever job it was asked for.
struct ObjectsAway : InputError {
    using InputError::InputError;
};

/// Calls something whose errors are those of the object store.
template <typename Call>
void call_objects(Call call) {
    try {
        call();
    } catch (const InputError& error) {
        throw ObjectsAway{error.what()};
    }
}

class JobWorker {
public:
    JobWorker(const JobWork& work, const Console& console)
        : work_{work}, console_{console}, options_{parse_import(work.import_arguments)},
          vehicles_{work.import_arguments}, taker_{new_worker_name(), work.lease},
          folder_{swept_temporary_name()} {
        options_.tell = work.tell;
        connect_queue();
        begin_worker(*queue_,
                     {.taker = taker_, .results_version = results_version, .jobs = options_.jobs},
                     work.takes_over);
        heartbeat_.emplace(work.address, taker_);
    }

    /// Works until it is stopped or done, and takes its row away, whatever ends it.
    void run() {
        try {
            connect();
            open_stores();
            work();
        } catch (...) {
            end();
            throw;
        }
        end();
    }

private:
    void work() {
        while (!console_.stop().stop_requested()) {
            try {
                delete_if_asked();
                connect();
                look_after();
                fuse_if_older_than(fuse_at_age, max_fusing);
                open_stores();
                if ((!work_batch() || is_limit_reached()) && !is_idle_done()) {
                    pause(look_every);
                } else if (is_done_) {
                    break;
                }
                trouble_.clear();
            } catch (const OtherResults&) { // it will not pass
                throw;
            } catch (const ObjectsAway& error) {
                if (wait_out(error, objects_trouble_, objects_pause_)) {
                    objects_pause_ = std::min(2 * objects_pause_, max_objects_pause);
                    stores_.clear(); // its keys may have been replaced
                }
            } catch (const InputError& error) {
                if (wait_out(error, trouble_, after_trouble)) {
                    store_.reset(); // its network may have been replaced
                    queue_.reset();
                }
            }
        }
    }

    /// While an error is handled that may pass: says it once, and pauses. Throws it on if the
    /// worker is to end when nothing waits. \returns false after a stop request.
    bool wait_out(const InputError& error, std::string& told, std::chrono::seconds about) {
        if (console_.stop().stop_requested()) {
            return false;
        }
        if (work_.until_empty) {
            throw;
        }
        if (std::exchange(told, error.what()) != error.what()) {
            console_.warn(error.what());
        }
        pause(about);
        return !console_.stop().stop_requested();
    }

    void connect_queue() {
        if (!queue_) {
            queue_.emplace(opened_server(work_.address));
            put_back_all(*queue_, taker_);
        }
    }

    void open_stores() {
        if (stores_.empty()) {
            const auto location =
                work_.objects.empty() ? objects_location(*queue_) : std::optional{work_.objects};
            call_objects([&] {
                while (location && stores_.size() < options_.jobs) {
                    stores_.push_back(
                        open_object_store(*location, console_.stop(), MissingFolder::refuse));
                }
            });
        }
    }

    void connect() {
        connect_queue();
        if (!store_) {
            store_.emplace(opened_for_import(work_.address, console_));
            make_missing_key(*store_->trips, console_);
            if (!std::exchange(is_role_told_, true)) {
                warn_of_importer(*store_, console_);
            }
            if (is_crowd() && work_.keeps_logs) {
                throw InputError{fmt::format("{}: is a crowd database, whose logs are erased once "
                                             "they are worked out; expected no --keep-logs",
                                             work_.address)};
            }
        }
    }

    bool is_crowd() const { return store_->map.settings().privacy == PrivacyProfile::crowd; }

    /// Takes and works out some jobs. \returns false if none waits.
    bool work_batch() {
        constexpr std::size_t retries_every = 4;
        if (stores_.empty()) {
            return false; // nothing was submitted so far
        }
        call_objects([&] { stores_.front()->expect_in_place(); });
        const auto taken =
            take_jobs(*queue_, taker_, batch_, batches_++ % retries_every == retries_every - 1);
        if (taken.empty()) {
            return false;
        }
        const auto begin = Clock::now();
        try {
            work_out(taken);
        } catch (const ObjectsAway&) { // after all were given back or imported
            throw;
        } catch (const ServerTrouble&) {
            put_back(taken, 2 * after_trouble); // others first: a limit may always meet these
            batch_ = std::max(batch_ / 2, options_.jobs);
            throw;
        } catch (const OtherResults&) {
            put_back(taken);
            throw;
        } catch (const std::exception& error) { // perhaps by one of them: each is tried alone
            count_failure(taken, error.what());
            throw;
        }
        adapt_batch(taken.size(), Clock::now() - begin);
        objects_answered();
        erase_done();
        return true;
    }

    void work_out(const std::vector<Job>& taken) {
        auto fetched = fetch_jobs(taken, folder_.path(), stores_);
        if (console_.stop().stop_requested()) {
            put_back(taken);
            return;
        }
        const auto trouble = give_back_unfetched(fetched);
        if (!fetched.empty()) {
            const auto worked = import_jobs(*store_, fetched, options_, vehicles_, console_);
            heartbeat_->add_finished(finish_jobs(*queue_, taker_, worked.ends));
            put_back_jobs(*queue_, taker_, worked.left);
        }
        if (!trouble.empty()) {
            throw ObjectsAway{trouble + "; its logs wait until it can be reached"};
        }
    }

    /// Gives jobs back whose logs were not fetched, and removes them from the list. Only a log that
    /// is missing or damaged has had an attempt. \returns why the store was not reached; "" if it
    /// was.
    std::string give_back_unfetched(std::vector<FetchedJob>& jobs) {
        using enum FetchedJob::Result;
        std::string trouble;
        for (const auto& [job, file, result, failure] : jobs) {
            if (result == unusable) {
                console_.warn(failure);
                fail_job(*queue_, taker_, job, failure);
            } else if (result == unreachable) { // others are tried before it, as it may be its own
                trouble = failure;
                put_back_jobs(*queue_, taker_, {&job, 1}, 2 * objects_pause_);
            } else if (result == left) {
                put_back_jobs(*queue_, taker_, {&job, 1});
            }
        }
        std::erase_if(jobs, [](const FetchedJob& one) { return one.result != fetched; });
        return trouble;
    }

    void objects_answered() {
        objects_trouble_.clear();
        objects_pause_ = after_trouble;
    }

    void count_failure(const std::vector<Job>& jobs, const std::string& reason) {
        if (console_.stop().stop_requested()) {
            put_back(jobs);
            return;
        }
        try {
            for (const auto& job : jobs) {
                fail_job(*queue_, taker_, job, reason);
            }
        } catch (const InputError&) {
            queue_.reset();
        }
    }

    /// After trouble of the server or a stop request; what cannot be given back comes free with its
    /// lease.
    void put_back(const std::vector<Job>& jobs, std::chrono::seconds pause = {}) {
        try {
            put_back_jobs(*queue_, taker_, jobs, pause);
        } catch (const InputError&) {
            queue_.reset();
        }
    }

    /// A batch is to take some seconds: fewer commits than one a log, and enough left for others.
    void adapt_batch(std::size_t taken, Clock::duration took) {
        if (took < 3s && taken == batch_) {
            batch_ = std::min(2 * batch_, max_batch);
        } else if (took > 10s) {
            batch_ = std::max(batch_ / 2, options_.jobs);
        }
    }

    /// Removes logs from the object store that are imported, or of a crowd and worked out, also
    /// those of killed workers, or were never submitted; and from the queue those that have been
    /// gone for long.
    void erase_done() {
        remove_old_jobs(*queue_, 2 * max_batch);
        for (std::size_t erased = 0; erased < 2 * max_batch && erase_some();) {
            erased += max_erased;
        }
        erase_unsubmitted();
    }

    /// Removes logs from the object store within a transaction of the queue, whose locks keep the
    /// same logs from being stored anew meanwhile: a slow store tries a log for minutes.
    void erase(const std::vector<std::string>& logs) {
        set_idle_limit(*queue_, "10min");
        SignOfLife life{*queue_};
        for (const auto& sha256 : logs) {
            call_objects([&] { stores_.front()->remove(sha256); });
            life.give();
        }
    }

    void erase_unsubmitted() {
        ServerTransaction all{*queue_};
        erase(end_old_announcements(*queue_, max_erased));
        all.commit();
    }

    /// \returns whether there may be more.
    bool erase_some() {
        const auto which = work_.keeps_logs ? ErasedLogs::forgotten
                           : is_crowd()     ? ErasedLogs::worked_out
                                            : ErasedLogs::imported;
        ServerTransaction all{*queue_};
        const auto done = jobs_to_erase(*queue_, max_erased, which);
        if (done.empty()) {
            return false;
        }
        note_erased(*queue_, done);
        std::vector<std::string> logs;
        for (const auto& job : done) {
            logs.push_back(job.sha256);
        }
        erase(logs);
        all.commit();
        objects_answered();
        return done.size() == max_erased;
    }

    /// Deletes trips whose senders ask for it, together with those of the next minute.
    void delete_if_asked() {
        if (Clock::now() < may_delete_at_) {
            return;
        }
        may_delete_at_ = Clock::now() + upkeep_every; // even if it fails
        connect_queue();
        if (has_deletions(*queue_)) {
            store_.reset();
            delete_trips_of_logs(work_.address, console_);
        }
    }

    /// Removes what killed importers left on servers of cells, and keeps counts short.
    void look_after() {
        if (Clock::now() >= upkeep_at_) {
            upkeep_at_ = Clock::now() + upkeep_every; // even if it fails
            remove_unfinished(*queue_);
            sum_job_counts(*queue_);
        }
    }

    /// Fuses if the oldest new passes wait for so long. Several workers divide the chunks.
    ///
    /// \param longest  after which trips have their turn: all chunks of a country take hours;
    ///                 `std::nullopt`: all are to be fused, also those that others fuse just now
    void fuse_if_older_than(std::chrono::seconds age, std::optional<std::chrono::seconds> longest) {
        const bool is_due =
            queue_->number(fmt::format("SELECT count(*) FROM (SELECT FROM macadam.chunk_dirty"
                                       " WHERE since_ms <= extract(epoch FROM clock_timestamp())"
                                       " * 1000 - {} LIMIT 1) AS oldest",
                                       std::chrono::milliseconds{age}.count())) > 0;
        if (!is_due || Clock::now() < may_fuse_at_) {
            return;
        }
        const auto begin = Clock::now();
        std::stop_source enough;
        const std::stop_callback stopped{console_.stop(), [&] { enough.request_stop(); }};
        const auto look = [&](std::size_t, std::size_t) {
            if (longest && Clock::now() - begin > *longest) {
                enough.request_stop();
            }
        };
        FusionRecord record;
        store_->trips->refresh({.report = look, .stop = enough.get_token()},
                               record,
                               longest ? BusyChunks::leave : BusyChunks::await);
        may_fuse_at_ = Clock::now() + 4 * (Clock::now() - begin); // a fifth of the time
    }

    bool is_worked_out() {
        return queue_->number(fmt::format(
                   "SELECT count(*) FROM (SELECT FROM macadam.job WHERE state IN"
                   " ('queued', 'working') AND number <= {} LIMIT 1) AS waiting",
                   work_.last_log.value_or(std::numeric_limits<std::int64_t>::max()))) == 0;
    }

    /// Others may be submitted without end.
    bool is_limit_reached() { return work_.last_log && is_worked_out(); }

    /// No job is free: fuses, at once if none is worked on either.
    /// \returns whether that is all there is to do.
    bool is_idle_done() {
        if (!stores_.empty()) {
            erase_done();
        }
        const bool is_empty = is_worked_out();
        if (is_empty) {
            may_fuse_at_ = {};
        }
        is_done_ = work_.until_empty && is_empty;
        fuse_if_older_than(is_empty ? 0s : fuse_at_age,
                           is_done_ ? std::nullopt : std::optional{max_fusing});
        return is_done_;
    }

    void pause(std::chrono::milliseconds about) {
        std::uniform_real_distribution<double> share{0.5, 1.5};
        std::mutex mutex;
        std::unique_lock lock{mutex};
        std::condition_variable_any stopped;
        stopped.wait_for(lock, console_.stop(), about * share(random_), [] { return false; });
    }

    void end() {
        heartbeat_.reset();
        try {
            if (queue_) {
                end_worker(*queue_, taker_.worker);
            }
        } catch (const InputError&) { // it counts as dead after its lease
            queue_.reset();
        }
    }

    const JobWork& work_;
    const Console& console_;
    ImportOptions options_;
    VehicleChoice vehicles_;
    JobTaker taker_;
    TemporaryFolder folder_;
    std::optional<ServerConnection> queue_;
    std::optional<ImportStore> store_;
    std::vector<std::unique_ptr<ObjectStore>> stores_; ///< one for each thread that fetches
    std::optional<WorkerHeartbeat> heartbeat_;
    std::size_t batch_ = 8;
    std::size_t batches_ = 0;
    Clock::time_point may_fuse_at_{};
    Clock::time_point upkeep_at_{};
    Clock::time_point may_delete_at_{};
    bool is_done_ = false;
    bool is_role_told_ = false;             ///< once, not after each trouble
    std::string trouble_, objects_trouble_; ///< as told last
    std::chrono::seconds objects_pause_ = after_trouble;
    std::minstd_rand random_{std::random_device{}()};
};

} // namespace

void work_out_jobs(const JobWork& work, const Console& console) {
    JobWorker{work, console}.run();
}

} // namespace macadam
