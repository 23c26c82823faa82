#include "app/store/log_backlog.hpp"

#include "app/jobs/job_options.hpp"
#include "app/jobs/job_worker.hpp"
#include "app/uploads/upload_work.hpp"
#include "estimator/common/error.hpp"
#include "storage/jobs/work_status.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <thread>

namespace macadam {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

std::string logs(std::int64_t count) {
    return counted(static_cast<std::size_t>(count), "log");
}

class BacklogWork {
public:
    BacklogWork(const std::string& address, const Console& console)
        : address_{address}, console_{console}, server_{opened_server(address)},
          last_{last_log_number(server_)}, backlog_{backlog_up_to(server_, last_)},
          all_{backlog_.waiting}, progress_{console.progress("importing", {.name = "log"})} {}

    void run() {
        if (all_ > 0) {
            console_.say(
                fmt::format("importing the logs that wait in the queue, first ({})", logs(all_)));
        }
        while (backlog_.waiting > 0) {
            if (console_.stop().stop_requested()) {
                throw InputError{fmt::format("{}: interrupted while logs were waiting; nothing "
                                             "was changed",
                                             address_)};
            }
            if (backlog_.lease) {
                wait_for_workers();
            } else {
                work_out();
            }
        }
    }

private:
    void work_out() {
        JobWork work{.address = address_, .objects = {}, .import_arguments = upload_arguments({})};
        work.until_empty = true;
        work.last_log = last_;
        work.tell = [&](const TripReport&) {
            if (Clock::now() > looked_at_ + 1s) {
                look();
            }
        };
        work_out_jobs(work, console_);
        look();
        stood_ = {};
    }

    void wait_for_workers() {
        const auto before = backlog_.waiting;
        const auto begin = Clock::now();
        // Counting takes a tenth of the time at most.
        std::this_thread::sleep_for(std::clamp<Clock::duration>(9 * asking_, 200ms, 2s));
        look();
        // An archive may take a worker minutes. It may also hang, in a folder whose server is gone.
        constexpr int while_worked_on = 10;
        stood_ += (Clock::now() - begin) / (backlog_.is_worked_on ? while_worked_on : 1);
        if (backlog_.waiting != before) {
            stood_ = {};
        }
        if (backlog_.lease && stood_ > 2 * *backlog_.lease) { // they fuse for a minute in between
            throw InputError{fmt::format(
                "{}: {} in the queue, and no worker imported any for {} s; nothing was changed: "
                "see whether workers reach the object store ('macadam status', their messages), "
                "and run the command again",
                address_,
                backlog_.waiting == 1 ? "a log waits" : logs(backlog_.waiting) + " wait",
                (2 * *backlog_.lease).count())};
        }
    }

    void look() {
        const auto begin = Clock::now();
        backlog_ = backlog_up_to(server_, last_);
        looked_at_ = Clock::now();
        asking_ = looked_at_ - begin;
        const auto done = std::max<std::int64_t>(all_ - backlog_.waiting, 0);
        progress_(static_cast<std::size_t>(done), static_cast<std::size_t>(all_));
    }

    const std::string& address_;
    const Console& console_;
    ServerConnection server_;
    std::int64_t last_; ///< number of the last log that counts
    Backlog backlog_;
    std::int64_t all_; ///< logs that waited at the beginning
    Progress progress_;
    Clock::time_point looked_at_ = Clock::now();
    Clock::duration asking_{}; ///< time that the last look took
    Clock::duration stood_{};  ///< without an end of any log
};

} // namespace

void work_out_backlog(const std::string& address, const Console& console) {
    BacklogWork{address, console}.run();
}

} // namespace macadam
