#include "storage/jobs/sent_logs.hpp"

#include "estimator/common/exact_number.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

/// To who sent it, a log that is parked is refused. Why it failed, also before it is tried again,
/// is a matter of the operator's machines.
constexpr const char* selecting_logs =
    "SELECT sha256, owner, suffix, bytes, floor(extract(epoch FROM submitted_at) * 1000)::bigint,"
    " CASE state WHEN 'parked' THEN 'refused' ELSE state END, attempts,"
    " (deleting OR reason = 'permanently deleted')::integer,"
    " CASE state WHEN 'parked' THEN 'the server could not import it; send it again later'"
    " WHEN 'queued' THEN '' WHEN 'working' THEN '' ELSE reason END,"
    " (SELECT count(*) FROM macadam.job_trip WHERE job_trip.job = sha256 AND imported), passes"
    " FROM macadam.job ";

/// Trips that were imported from a log and are in the database.
constexpr const char* its_trips =
    "SELECT FROM macadam.job_trip JOIN macadam.trip ON trip.sha256 = job_trip.trip"
    " WHERE job_trip.job = job.sha256 AND imported";

/// Changes of jobs that are to be erased as forgotten ones are (job_queue.cpp).
constexpr const char* ended_as_deleted =
    "state = 'known', reason = 'permanently deleted', finished_at = now(), not_before = now(),"
    " lease_until = NULL, worker = NULL, has_object = true, deleting = false";

std::int64_t number_in(const std::optional<std::string>& text) {
    return text ? exact_number<std::int64_t>(*text).value_or(0) : 0;
}

Upload upload_in(const ServerRow& row) {
    return {.sha256 = row[0].value_or(""),
            .owner = row[1].value_or(""),
            .suffix = row[2].value_or(""),
            .bytes = number_in(row[3]),
            .received_ms = number_in(row[4]),
            .state = state_named(row[5].value_or("")),
            .attempts = static_cast<int>(number_in(row[6])),
            .deleting = row[7] == "1",
            .reason = row[8].value_or(""),
            .trips = static_cast<std::size_t>(number_in(row[9])),
            .passes = number_in(row[10])};
}

} // namespace

std::optional<Upload> find_sent_log(ServerConnection& server, const std::string& sha256) {
    const auto rows = server.rows(fmt::format("{} WHERE sha256 = $1", selecting_logs), {sha256});
    return rows.empty() ? std::nullopt : std::optional{upload_in(rows[0])};
}

std::vector<Upload>
latest_sent_logs(ServerConnection& server, const std::string& owner, std::size_t limit) {
    std::vector<std::optional<std::string>> values{std::to_string(limit)};
    if (!owner.empty()) {
        values.emplace_back(owner);
    }
    std::vector<Upload> logs;
    for (const auto& row : server.rows(fmt::format("{} {} ORDER BY number DESC LIMIT $1",
                                                   selecting_logs,
                                                   owner.empty() ? "" : "WHERE owner = $2"),
                                       values)) {
        logs.push_back(upload_in(row));
    }
    return logs;
}

std::size_t count_waiting_logs(ServerConnection& server, std::size_t most) {
    return static_cast<std::size_t>(
        server.number(fmt::format("SELECT count(*) FROM (SELECT FROM macadam.job"
                                  " WHERE state IN ('queued', 'working') LIMIT {}) AS waiting",
                                  most)));
}

void confirm_log(ServerConnection& server, const std::string& sha256) {
    ServerTransaction one{server};
    server.rows("UPDATE macadam.job SET submissions = submissions + 1 WHERE sha256 = $1", {sha256});
    one.commit();
}

std::optional<Job> delete_log(ServerConnection& server, const std::string& sha256) {
    ServerTransaction one{server};
    // A log that a worker has begun may have its trips in the database already.
    const auto rows =
        server.rows(fmt::format("SELECT suffix, bytes, CASE WHEN state IN ('queued', 'working')"
                                " THEN state = 'queued' AND worker IS NULL ELSE NOT EXISTS ({}) END"
                                " FROM macadam.job WHERE sha256 = $1 FOR UPDATE",
                                its_trips),
                    {sha256});
    if (rows.empty()) {
        return std::nullopt;
    }
    const bool is_untouched = rows[0][2] == "t";
    server.rows(fmt::format("UPDATE macadam.job SET {} WHERE sha256 = $1",
                            is_untouched ? ended_as_deleted : "deleting = true"),
                {sha256});
    one.commit();
    return is_untouched ? std::optional{Job{.sha256 = sha256,
                                            .suffix = rows[0][0].value_or(""),
                                            .bytes = number_in(rows[0][1])}}
                        : std::nullopt;
}

bool has_deletions(ServerConnection& server) {
    // What importers may not write, too, is the operator's.
    return server.number("SELECT (has_table_privilege('macadam.valid_from', 'DELETE') AND EXISTS"
                         " (SELECT FROM macadam.job WHERE deleting"
                         " AND state NOT IN ('queued', 'working')))::integer") != 0;
}

std::vector<std::string> trips_to_delete(ServerConnection& server, std::size_t limit) {
    std::vector<std::string> trips;
    for (const auto& row :
         server.rows("SELECT DISTINCT trip.sha256 FROM macadam.job"
                     " JOIN macadam.job_trip ON job_trip.job = job.sha256 AND imported"
                     " JOIN macadam.trip ON trip.sha256 = job_trip.trip"
                     " WHERE deleting AND state NOT IN ('queued', 'working') LIMIT $1",
                     {std::to_string(limit)})) {
        trips.push_back(row[0].value_or(""));
    }
    return trips;
}

void end_deleted_jobs(ServerConnection& server) {
    server.run(fmt::format("WITH ending AS (SELECT sha256 FROM macadam.job WHERE deleting"
                           " AND state NOT IN ('queued', 'working') AND NOT EXISTS ({})"
                           " ORDER BY sha256 FOR UPDATE)"
                           " UPDATE macadam.job SET {} FROM ending"
                           " WHERE job.sha256 = ending.sha256",
                           its_trips,
                           ended_as_deleted));
}

} // namespace macadam
