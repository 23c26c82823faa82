#include "app/uploads/upload_workers.hpp"

#include "app/reprocess/kept_trips.hpp"
#include "estimator/common/error.hpp"
#include "storage/uploads/upload_database.hpp"
#include "storage/uploads/upload_queue.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <utility>

namespace macadam {
namespace {

using namespace std::chrono_literals;

constexpr auto look_every = 1s;
constexpr auto after_trouble = 5s;
constexpr auto erase_every = 10min;

} // namespace

UploadWorkers::UploadWorkers(const UploadWork& asked, std::size_t count, const Console& console) {
    auto work = asked;
    work.running_since = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < count; ++i) {
        threads_.emplace_back(
            [this, work, &console] { this->work(work, console, stop_.get_token()); });
    }
}

UploadWorkers::~UploadWorkers() {
    request_stop();
}

void UploadWorkers::wake() {
    const std::lock_guard lock{mutex_};
    ++woken_;
    changed_.notify_all();
}

void UploadWorkers::request_stop() {
    stop_.request_stop();
}

void UploadWorkers::work(const UploadWork& work,
                         const Console& console,
                         const std::stop_token& stop) {
    const Console quiet{Verbosity::quiet, stop};
    std::optional<Database> uploads;
    std::optional<WorkerMark> mark;
    std::string trouble;
    std::size_t seen = 0;
    auto erasing = std::chrono::steady_clock::now();
    while (!stop.stop_requested()) {
        std::chrono::milliseconds pause = look_every;
        try {
            if (!uploads && takes_uploads(work.store)) {
                uploads = open_uploads(work.store, {.stop = stop});
                mark.emplace(spool_of(work.store));
                sweep_spool(*uploads, spool_of(work.store));
            }
            if (const auto now = std::chrono::steady_clock::now(); uploads && now >= erasing) {
                erasing = now + erase_every;
                erase_old_logs_of(work.store, *uploads, quiet); // first, as an import may fail
            }
            if (uploads && work_out_uploads(*uploads, work, quiet)) {
                pause = 0s;
            }
            trouble.clear();
        } catch (const std::exception& error) {
            if (!stop.stop_requested() && std::exchange(trouble, error.what()) != error.what()) {
                console.warn(error.what());
            }
            uploads.reset(); // it may have been moved away
            pause = after_trouble;
        }
        std::unique_lock lock{mutex_};
        changed_.wait_for(lock, stop, pause, [&] { return woken_ != seen; });
        seen = woken_;
    }
}

} // namespace macadam
