#include "storage/jobs/announced_logs.hpp"

#include "storage/jobs/worker_register.hpp"

namespace macadam {

void announce_logs(ServerConnection& server,
                   std::span<const Job> logs,
                   const std::string& objects) {
    const auto hashes = hashes_of(logs);
    ServerTransaction one{server};
    share_objects_location(server, objects);
    // First the jobs, as submit_logs().
    server.rows("WITH done AS (SELECT sha256 FROM macadam.job WHERE sha256 = ANY($1)"
                " AND state IN ('outside', 'refused') ORDER BY sha256 FOR UPDATE)"
                " UPDATE macadam.job SET has_object = true, not_before = now() + interval '1 day'"
                " FROM done WHERE job.sha256 = done.sha256",
                {hashes});
    server.rows("INSERT INTO macadam.announced_log (sha256) SELECT sha256"
                " FROM unnest($1::text[]) AS log (sha256) ORDER BY 1"
                " ON CONFLICT (sha256) DO UPDATE SET announced_at = now()",
                {hashes});
    one.commit();
}

std::vector<std::string> end_old_announcements(ServerConnection& server, std::size_t limit) {
    std::vector<std::string> hashes;
    for (const auto& row :
         server.rows("WITH old AS (SELECT sha256 FROM macadam.announced_log"
                     " WHERE announced_at < now() - interval '1 day'"
                     " ORDER BY announced_at LIMIT $1 FOR UPDATE SKIP LOCKED),"
                     " ended AS (DELETE FROM macadam.announced_log USING old"
                     " WHERE announced_log.sha256 = old.sha256 RETURNING announced_log.sha256)"
                     " SELECT sha256 FROM ended WHERE NOT EXISTS"
                     " (SELECT FROM macadam.job WHERE job.sha256 = ended.sha256)",
                     {std::to_string(limit)})) {
        hashes.push_back(row[0].value_or(""));
    }
    return hashes;
}

} // namespace macadam
