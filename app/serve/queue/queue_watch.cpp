#include "app/serve/queue/queue_watch.hpp"

#include "app/jobs/job_options.hpp"
#include "app/jobs/status_output.hpp"
#include "estimator/common/error.hpp"
#include "storage/postgres/server_connection.hpp"

#include <algorithm>
#include <utility>

namespace macadam {
namespace {

std::int64_t now_ms() {
    return std::chrono::duration_cast<std::chrono::milliseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

QueueReading read_queue(std::optional<ServerConnection>& server, const std::string& address) {
    if (!server) {
        server.emplace(opened_server(address));
    }
    QueueReading reading;
    reading.is_closed = !may_read_work(*server);
    if (reading.is_closed) {
        reading.problem = "the role of this server may not read the queue, expected a member of "
                          "macadam_importer";
    } else {
        reading.status = work_status(*server, max_shown_failures);
    }
    reading.read_ms = now_ms();
    return reading;
}

} // namespace

QueueWatch::QueueWatch(std::string address, const Console& console)
    : address_{std::move(address)}, console_{console},
      latest_{
          std::make_shared<const QueueReading>(QueueReading{.problem = "the queue is being read"})},
      thread_{[this](const std::stop_token& stop) { work(stop); }} {}

std::shared_ptr<const QueueReading> QueueWatch::latest() {
    std::shared_ptr<const QueueReading> reading;
    {
        const std::lock_guard lock{mutex_};
        asked_ = Clock::now();
        reading = latest_;
    }
    changed_.notify_all();
    return reading;
}

std::string QueueWatch::metrics() {
    const auto reading = latest();
    if (reading->is_closed) {
        return {};
    }
    const std::string head = "# TYPE macadam_queue_up gauge\nmacadam_queue_up ";
    return reading->status ? head + "1\n" + status_metrics(*reading->status) : head + "0\n";
}

void QueueWatch::work(const std::stop_token& stop) {
    std::optional<ServerConnection> server;
    std::string trouble;
    std::unique_lock lock{mutex_};
    while (changed_.wait(lock, stop, [this] { return is_asked_for(); }) && !stop.stop_requested()) {
        lock.unlock();
        const auto begin = Clock::now();
        QueueReading reading;
        try {
            reading = read_queue(server, address_);
            trouble.clear();
        } catch (const std::exception& error) { // what it says of the server is for its log alone
            server.reset();
            reading.problem = "the database cannot be read now";
            if (std::exchange(trouble, error.what()) != error.what()) {
                console_.warn(error.what());
            }
        }
        // A long queue takes its time to be counted: at most for a tenth of the time.
        const auto pause = std::max<Clock::duration>(min_pause, 9 * (Clock::now() - begin));
        lock.lock();
        latest_ = std::make_shared<const QueueReading>(std::move(reading));
        changed_.wait_for(lock, stop, pause, [] { return false; });
    }
}

} // namespace macadam
