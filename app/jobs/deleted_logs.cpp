#include "app/jobs/deleted_logs.hpp"

#include "app/database/lock_wait_messages.hpp"
#include "app/jobs/forgotten_logs.hpp"
#include "app/jobs/job_options.hpp"
#include "storage/jobs/sent_logs.hpp"
#include "storage/postgres/idle_limit.hpp"
#include "storage/store/road_store.hpp"
#include "storage/store/server/replica/server_replica.hpp"
#include "storage/store/server/server_locks.hpp"

#include <cstddef>

namespace macadam {

void delete_trips_of_logs(const std::string& address, const Console& console) {
    constexpr std::size_t at_most = 1000; // of one call: importers wait
    auto server = opened_server(address);
    ServerTransaction one{server};
    set_idle_limit(server, "0");       // all trips are deleted in it, by another connection
    if (!try_take_deletions(server)) { // another worker does it
        return;
    }
    const ForgetRequest request{.trips = trips_to_delete(server, at_most), .vehicles = {}};
    if (!request.trips.empty()) {
        const auto progress = console.progress("deleting");
        RoadStore store{
            open_replica_to_forget(address, request, wait_policy_for(address, console), progress)};
        store.maintenance.forget(request, progress);
    }
    end_deleted_jobs(server);
    one.commit();
    erase_forgotten_logs(address, console);
}

} // namespace macadam
