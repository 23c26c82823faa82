#include "storage/jobs/worker_register.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <random>
#include <utility>
#include <vector>

#include <unistd.h>

namespace macadam {
namespace {

std::optional<std::string> setting(ServerConnection& server, const std::string& key) {
    const auto rows = server.rows("SELECT value FROM macadam.work_setting WHERE key = $1", {key});
    return rows.empty() ? std::nullopt : rows[0][0];
}

void put_setting(ServerConnection& server, const std::string& key, const std::string& value) {
    server.rows("INSERT INTO macadam.work_setting VALUES ($1, $2)"
                " ON CONFLICT (key) DO UPDATE SET value = excluded.value",
                {key, value});
}

std::string lease_of(const JobTaker& taker) {
    return std::to_string(taker.lease.count());
}

std::int64_t count_living_workers(ServerConnection& server) {
    return server.number(
        "SELECT count(*) FROM macadam.worker WHERE seen_at > now() - lease_s * interval '1 s'");
}

constexpr const char* version_key = "results_version";
constexpr const char* objects_key = "objects";

/// The same folder, or prefix of a bucket, may be named with a slash at its end.
std::string without_slash(std::string location) {
    while (location.size() > 1 && location.ends_with('/')) {
        location.pop_back();
    }
    return location;
}

/// \throws InputError  if a log lies in the object store, or a worker looks for them there.
void expect_nothing_stored(ServerConnection& server, const std::string& location) {
    std::vector<std::string> stored;
    for (const auto& row :
         server.rows("SELECT state, count(*) FROM macadam.job"
                     " WHERE state IN ('queued', 'working', 'parked') GROUP BY state"
                     " UNION ALL SELECT state, count(*) FROM macadam.job WHERE has_object"
                     " AND state IN ('imported', 'known', 'outside', 'refused') GROUP BY state"
                     " UNION ALL SELECT 'not queued so far', count(*) FROM macadam.announced_log"
                     " HAVING count(*) > 0 ORDER BY 1")) {
        stored.push_back(fmt::format("{} {}", row[1].value_or(""), row[0].value_or("")));
    }
    if (!stored.empty()) {
        throw InputError{fmt::format("{}: logs lie in {}, where workers look for all logs: {}; "
                                     "submit to it, or move it (docs/reference/workers.md)",
                                     server.address(),
                                     location,
                                     fmt::join(stored, ", "))};
    }
    if (const auto workers = count_living_workers(server); workers > 0) {
        throw InputError{
            fmt::format("{}: {} still at work, and would go on looking for logs in "
                        "{}; end them before another store is submitted to",
                        server.address(),
                        workers == 1 ? "a worker is" : fmt::format("{} workers are", workers),
                        location)};
    }
}

[[noreturn]] void refuse_other_results(const ServerConnection& server,
                                       const std::string& theirs,
                                       int ours,
                                       const std::string& what_to_do) {
    throw OtherResults{fmt::format("{}: its workers compute results of version {}, this program "
                                   "those of version {}: values of both must not mix; {}",
                                   server.address(),
                                   theirs,
                                   ours,
                                   what_to_do)};
}

} // namespace

std::string new_worker_name() {
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0) {
        host[0] = '?';
    }
    return fmt::format("{}/{}/{:08x}", host.data(), ::getpid(), std::random_device{}());
}

void expect_results_version(const ServerConnection& server, const std::string& theirs, int ours) {
    if (!theirs.empty() && theirs != std::to_string(ours)) {
        refuse_other_results(server,
                             theirs,
                             ours,
                             "expected the same program on all machines; a newer one decides with "
                             "'macadam worker --take-over'");
    }
}

void expect_results_version(ServerConnection& server, int ours) {
    expect_results_version(server, setting(server, version_key).value_or(""), ours);
}

void begin_worker(ServerConnection& server, const WorkerEntry& entry, bool takes_over) {
    const auto ours = std::to_string(entry.results_version);
    ServerTransaction one{server};
    server.run("LOCK TABLE macadam.work_setting IN SHARE ROW EXCLUSIVE MODE"); // one at a time
    const auto theirs = setting(server, version_key);
    const auto others = count_living_workers(server);
    if (theirs && *theirs != ours && (!takes_over || others > 0)) {
        refuse_other_results(
            server,
            *theirs,
            entry.results_version,
            others > 0 ? fmt::format("{} still at work, expected the same program on all machines",
                                     others == 1 ? "one is" : fmt::format("{} are", others))
                       : "install the same program on all machines, or let this one decide with "
                         "--take-over");
    }
    put_setting(server, version_key, ours);
    server.run("DELETE FROM macadam.worker WHERE seen_at < now() - interval '1 day'");
    server.rows("INSERT INTO macadam.worker (name, results_version, jobs, lease_s)"
                " VALUES ($1, $2, $3, $4)",
                {entry.taker.worker, ours, std::to_string(entry.jobs), lease_of(entry.taker)});
    one.commit();
}

void renew_worker(ServerConnection& server, const JobTaker& taker, std::int64_t finished) {
    // A row that is locked is being finished, or submitted again: never wait for it.
    server.rows("WITH mine AS (SELECT sha256 FROM macadam.job WHERE worker = $1"
                " AND state = 'working' FOR UPDATE SKIP LOCKED)"
                " UPDATE macadam.job SET lease_until = now() + $2::interval FROM mine"
                " WHERE job.sha256 = mine.sha256",
                {taker.worker, lease_of(taker) + " s"});
    server.rows("UPDATE macadam.worker SET seen_at = now(), finished = $2 WHERE name = $1",
                {taker.worker, std::to_string(finished)});
}

void end_worker(ServerConnection& server, const std::string& name) {
    server.rows("DELETE FROM macadam.worker WHERE name = $1", {name});
}

std::optional<std::string> objects_location(ServerConnection& server) {
    auto location = setting(server, objects_key);
    return location ? std::optional{without_slash(*std::move(location))} : std::nullopt;
}

void share_objects_location(ServerConnection& server, const std::string& location) {
    if (location.empty()) {
        return;
    }
    server.rows("SELECT FROM macadam.work_setting WHERE key = 'objects' FOR SHARE");
    if (const auto last = objects_location(server); last != without_slash(location)) {
        throw InputError{fmt::format("{}: somebody else has just submitted to {}, where workers "
                                     "look for all logs; expected {}: submit to the same store",
                                     server.address(),
                                     last.value_or("no store"),
                                     location)};
    }
}

void put_objects_location(ServerConnection& server, const std::string& location) {
    const auto next = without_slash(location);
    if (objects_location(server) == next) {
        return;
    }
    ServerTransaction one{server};
    server.run("LOCK TABLE macadam.work_setting IN SHARE ROW EXCLUSIVE MODE"); // one at a time
    server.rows("SELECT FROM macadam.work_setting WHERE key = $1 FOR UPDATE",
                {objects_key}); // share_objects_location() waits, or is waited for
    if (const auto last = objects_location(server); last && *last != next) {
        expect_nothing_stored(server, *last);
    }
    put_setting(server, objects_key, next);
    one.commit();
}

} // namespace macadam
