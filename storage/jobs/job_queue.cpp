#include "storage/jobs/job_queue.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/exact_number.hpp"
#include "storage/jobs/job_schema.hpp"
#include "storage/jobs/worker_register.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

namespace macadam {
namespace {

std::int64_t number_in(const std::optional<std::string>& text) {
    return text ? exact_number<std::int64_t>(*text).value_or(0) : 0;
}

/// Array of PostgreSQL of what one function gives for each job. Hashes, suffixes and numbers need
/// no quoting; other text never comes here.
template <typename Value>
std::string array_of(std::span<const Job> jobs, Value value) {
    std::string text;
    for (const auto& job : jobs) {
        text += fmt::format("{}\"{}\"", text.empty() ? "" : ",", value(job));
    }
    return "{" + text + "}";
}

constexpr const char* removing_old_jobs =
    "DELETE FROM macadam.job WHERE sha256 IN (SELECT sha256 FROM macadam.job"
    " WHERE finished_at < now() - interval '400 days' AND NOT has_object"
    " AND state IN ('imported', 'known', 'outside', 'refused')"
    " AND (owner IS NULL OR state <> 'imported')" // who sent it may delete it
    " ORDER BY finished_at LIMIT $1 FOR UPDATE SKIP LOCKED)";

constexpr const char* job_columns = "sha256, suffix, bytes, attempts";

std::vector<Job> jobs_in(const std::vector<ServerRow>& rows) {
    std::vector<Job> jobs;
    for (const auto& row : rows) {
        jobs.push_back({.sha256 = row[0].value_or(""),
                        .suffix = row[1].value_or(""),
                        .bytes = number_in(row[2]),
                        .attempts = static_cast<int>(number_in(row[3])),
                        .was_begun = row.size() > 4 && row[4] == "t"});
    }
    return jobs;
}

/// Reason of a job that was ended because a trip of its log was permanently deleted.
constexpr const char* forgotten_reason = "permanently deleted";
constexpr const char* was_forgotten = "AND state = 'known' AND reason = 'permanently deleted'";

/// State before, of those that are there.
std::map<std::string, UploadState>
known_states(ServerConnection& server, std::span<const Job> logs, std::string_view lock) {
    std::map<std::string, UploadState> states;
    for (const auto& row :
         server.rows(fmt::format("SELECT sha256, state FROM macadam.job WHERE sha256 = ANY($1)"
                                 " ORDER BY sha256 {}",
                                 lock),
                     {hashes_of(logs)})) {
        states.emplace(row[0].value_or(""), state_named(row[1].value_or("")));
    }
    return states;
}

/// Condition for those that no one has, or whose worker let its lease run out.
constexpr const char* is_free =
    "state IN ('queued', 'working')"
    " AND (state = 'queued' AND not_before <= now() OR lease_until < now())";

/// Attempts of the first job that is due again; 0 if none is.
std::int64_t attempts_of_next_retry(ServerConnection& server) {
    const auto found = server.numbers(
        fmt::format("SELECT attempts FROM macadam.job WHERE {} AND attempts > 0 AND attempts < {}"
                    " ORDER BY number LIMIT 1 FOR UPDATE SKIP LOCKED",
                    is_free,
                    max_job_attempts));
    return found.empty() ? 0 : found.front();
}

/// Takes free ones with so many attempts. \param attempts  0: "= 0", by its index
std::vector<Job>
take(ServerConnection& server, const JobTaker& taker, std::size_t at_most, std::int64_t attempts) {
    return jobs_in(server.rows(
        fmt::format("WITH next AS (SELECT sha256, worker IS NOT NULL AS was_begun"
                    " FROM macadam.job WHERE {} AND attempts {}"
                    " ORDER BY number LIMIT $3 FOR UPDATE SKIP LOCKED)"
                    " UPDATE macadam.job SET state = 'working', attempts = attempts + 1,"
                    " worker = $1, lease_until = now() + $2::interval"
                    " FROM next WHERE job.sha256 = next.sha256 RETURNING job.{}",
                    is_free,
                    attempts == 0 ? "= 0" : fmt::format("> 0 AND attempts = {}", attempts),
                    "sha256, job.suffix, job.bytes, job.attempts, was_begun"),
        {taker.worker, fmt::format("{} s", taker.lease.count()), std::to_string(at_most)}));
}

/// Parks jobs at which their fifth worker ended.
void park_dead(ServerConnection& server) {
    server.rows(fmt::format(
        "UPDATE macadam.job SET state = 'parked', finished_at = now(), lease_until = NULL,"
        " reason = 'its worker ended ' || attempts || ' times at this log' ||"
        " CASE WHEN reason = '' THEN '' ELSE '; before: ' || reason END"
        " WHERE sha256 IN (SELECT sha256 FROM macadam.job WHERE state = 'working'"
        " AND attempts >= {} AND lease_until < now() FOR UPDATE SKIP LOCKED)",
        max_job_attempts));
}

/// Condition by which a job is still the caller's: $1 job, $2 worker, $3 attempt.
constexpr const char* is_ours =
    " WHERE sha256 = $1 AND worker = $2 AND attempts = $3 AND state = 'working'";

std::vector<std::optional<std::string>> ours(const JobTaker& taker, const Job& job) {
    return {job.sha256, taker.worker, std::to_string(job.attempts)};
}

/// Ends the announcements of logs. Of those that are new, or tried again, the object is gone where
/// it was erased after the announcement grew old.
/// \throws InputError  if any is.
void end_announcements(ServerConnection& server,
                       std::span<const Job> logs,
                       std::map<std::string, std::int64_t>& submissions) {
    std::set<std::string> lost;
    for (const auto& log : logs) {
        if (submissions[log.sha256] == 1) {
            lost.insert(log.sha256);
        }
    }
    // In the order in which announce_logs() locks them.
    for (const auto& row :
         server.rows("WITH announced AS (SELECT sha256 FROM macadam.announced_log"
                     " WHERE sha256 = ANY($1) ORDER BY sha256 FOR UPDATE)"
                     " DELETE FROM macadam.announced_log USING announced"
                     " WHERE announced_log.sha256 = announced.sha256 RETURNING announced.sha256,"
                     " announced_at > clock_timestamp() - interval '1 day'",
                     {hashes_of(logs)})) {
        if (row[1] == "t") { // else who erases it may have been interrupted
            lost.erase(row[0].value_or(""));
        }
    }
    for (const auto& row : server.rows("SELECT sha256 FROM macadam.job WHERE sha256 = ANY($1)"
                                       " AND state IN ('outside', 'refused') AND NOT has_object",
                                       {hashes_of(logs)})) {
        lost.insert(row[0].value_or(""));
    }
    if (!lost.empty()) {
        throw InputError{
            fmt::format("{}: {} not in the object store any more, such as {}; nothing was "
                        "queued: store and submit {} again",
                        server.address(),
                        lost.size() == 1 ? "a log is" : fmt::format("{} logs are", lost.size()),
                        *lost.begin(),
                        lost.size() == 1 ? "it" : "them")};
    }
}

/// Changes of jobs that are tried again.
constexpr const char* queued_again = "state = 'queued', attempts = 0, reason = '',"
                                     " not_before = now(), worker = NULL, finished_at = NULL,"
                                     " has_object = true";

} // namespace

std::string hashes_of(std::span<const Job> jobs) {
    return array_of(jobs, [](const Job& job) { return job.sha256; });
}

std::vector<std::optional<UploadState>> states_of_logs(ServerConnection& server,
                                                       std::span<const Job> logs) {
    const auto known = known_states(server, logs, "");
    std::vector<std::optional<UploadState>> states;
    for (const auto& log : logs) {
        const auto found = known.find(log.sha256);
        states.push_back(found == known.end() ? std::nullopt : std::optional{found->second});
    }
    return states;
}

std::vector<Submission> submit_logs(ServerConnection& server,
                                    std::span<const Job> logs,
                                    const std::string& objects,
                                    const std::string& owner) {
    ServerTransaction one{server};
    share_objects_location(server, objects);
    const auto before = known_states(server, logs, "FOR UPDATE");
    std::map<std::string, std::int64_t> submissions;
    // A known row is written, too: then the commit waits for the standby, which may lack it.
    const auto rows = server.rows(
        "INSERT INTO macadam.job (sha256, suffix, bytes, owner) SELECT log.*, nullif($4::text, '')"
        " FROM unnest($1::text[], $2::text[], $3::bigint[]) AS log (sha256) ORDER BY 1"
        " ON CONFLICT (sha256) DO UPDATE SET submissions = job.submissions + 1"
        " RETURNING sha256, submissions",
        {hashes_of(logs),
         array_of(logs, [](const Job& log) { return log.suffix; }),
         array_of(logs, [](const Job& log) { return log.bytes; }),
         owner});
    for (const auto& row : rows) {
        submissions[row[0].value_or("")] = number_in(row[1]);
    }
    end_announcements(server, logs, submissions);
    server.rows(fmt::format("UPDATE macadam.job SET {} WHERE sha256 = ANY($1)"
                            " AND state IN ('outside', 'refused', 'parked')",
                            queued_again),
                {hashes_of(logs)});
    one.commit();
    std::vector<Submission> results;
    for (const auto& log : logs) {
        const auto found = before.find(log.sha256);
        results.push_back(found != before.end() && is_tried_again(found->second)
                              ? Submission::requeued
                          : submissions[log.sha256] == 1 ? Submission::added
                                                         : Submission::known);
    }
    return results;
}

std::size_t submit_parked_logs(ServerConnection& server) {
    return server
        .rows(fmt::format("WITH parked AS (SELECT sha256 FROM macadam.job WHERE state = 'parked'"
                          " ORDER BY sha256 FOR UPDATE)"
                          " UPDATE macadam.job SET {} FROM parked"
                          " WHERE job.sha256 = parked.sha256 RETURNING 1",
                          queued_again))
        .size();
}

std::vector<Job> take_jobs(ServerConnection& server,
                           const JobTaker& taker,
                           std::size_t at_most,
                           bool first_retries) {
    park_dead(server);
    for (const bool is_retry : {first_retries, !first_retries}) {
        const auto attempts = is_retry ? attempts_of_next_retry(server) : 0;
        if (is_retry && attempts == 0) {
            continue;
        }
        // Those that share a batch with one that ends its worker are alone in the end.
        const auto count =
            attempts + 1 < max_job_attempts ? std::max<std::size_t>(at_most >> attempts, 1) : 1;
        auto taken = take(server, taker, count, attempts);
        if (!taken.empty()) {
            return taken;
        }
    }
    return {};
}

std::size_t
finish_jobs(ServerConnection& server, const JobTaker& taker, std::span<const JobEnd> ends) {
    // In the order of their hashes, in which submit_logs() locks them, too.
    std::vector<const JobEnd*> ordered;
    for (const auto& end : ends) {
        ordered.push_back(&end);
    }
    std::ranges::sort(ordered, {}, [](const JobEnd* end) { return end->job.sha256; });
    ServerTransaction one{server};
    std::size_t count = 0;
    for (const auto* const next : ordered) {
        const auto& end = *next;
        auto values = ours(taker, end.job);
        values.insert(values.end(),
                      {std::string{name_of(end.state)}, end.reason, std::to_string(end.passes)});
        const auto ended =
            server.rows(std::string{"UPDATE macadam.job SET state = $4, reason = $5,"
                                    " passes = $6, finished_at = now(), lease_until = NULL"} +
                            is_ours + " RETURNING 1",
                        values);
        if (!ended.empty() && !end.trips.empty()) {
            // One log alone has imported a trip, whoever says so later.
            server.rows("INSERT INTO macadam.job_trip (trip, job, imported)"
                        " SELECT DISTINCT trip, $2::text, trip = ANY($3::text[]) AND NOT EXISTS"
                        " (SELECT FROM macadam.job_trip AS other WHERE other.trip = log.trip"
                        " AND other.job <> $2 AND other.imported)"
                        " FROM unnest($1::text[]) AS log (trip) ON CONFLICT (trip, job)"
                        " DO UPDATE SET imported = job_trip.imported OR excluded.imported",
                        {fmt::format("{{{}}}", fmt::join(end.trips, ",")),
                         end.job.sha256,
                         fmt::format("{{{}}}", fmt::join(end.own, ","))});
        }
        count += ended.size();
    }
    one.commit();
    return count;
}

void fail_job(ServerConnection& server,
              const JobTaker& taker,
              const Job& job,
              const std::string& reason) {
    auto values = ours(taker, job);
    values.emplace_back(reason);
    const bool is_last = job.attempts >= max_job_attempts;
    // 2, 4, 8, 16 s and up to as much again, so that many do not come back at one moment.
    server.rows(std::string{"UPDATE macadam.job SET lease_until = NULL, reason = $4, "} +
                    (is_last ? "state = 'parked', finished_at = now()"
                             : "state = 'queued', not_before = now() +"
                               " (1 + random()) * 2 ^ attempts * interval '1 s'") +
                    is_ours,
                values);
}

void put_back_jobs(ServerConnection& server,
                   const JobTaker& taker,
                   std::span<const Job> jobs,
                   std::chrono::seconds pause) {
    for (const auto& job : jobs) {
        auto values = ours(taker, job);
        values.emplace_back(fmt::format("{} s", pause.count()));
        server.rows(std::string{"UPDATE macadam.job SET state = 'queued', attempts = attempts - 1,"
                                " not_before = now() + $4::interval, lease_until = NULL"} +
                        is_ours,
                    values);
    }
}

void put_back_all(ServerConnection& server, const JobTaker& taker) {
    server.rows("WITH mine AS (SELECT sha256 FROM macadam.job WHERE worker = $1"
                " AND state = 'working' ORDER BY sha256 FOR UPDATE)"
                " UPDATE macadam.job SET state = 'queued', attempts = attempts - 1,"
                " lease_until = NULL FROM mine WHERE job.sha256 = mine.sha256",
                {taker.worker});
}

std::vector<Job> jobs_to_erase(ServerConnection& server, std::size_t limit, ErasedLogs which) {
    return jobs_in(
        server.rows(fmt::format("SELECT {} FROM macadam.job WHERE has_object"
                                " AND not_before <= now()"
                                " AND state IN ('imported', 'known'{}) {} ORDER BY number LIMIT $1"
                                " FOR UPDATE SKIP LOCKED",
                                job_columns,
                                which == ErasedLogs::worked_out ? ", 'outside', 'refused'" : "",
                                which == ErasedLogs::forgotten ? was_forgotten : ""),
                    {std::to_string(limit)}));
}

void note_erased(ServerConnection& server, std::span<const Job> jobs) {
    server.rows("WITH done AS (SELECT sha256 FROM macadam.job WHERE sha256 = ANY($1)"
                " AND state IN ('imported', 'known', 'outside', 'refused') FOR UPDATE SKIP LOCKED)"
                " UPDATE macadam.job SET has_object = false FROM done"
                " WHERE job.sha256 = done.sha256",
                {hashes_of(jobs)});
    remove_forgotten_jobs(server, jobs);
}

void remove_old_jobs(ServerConnection& server, std::size_t limit) {
    server.rows(removing_old_jobs, {std::to_string(limit)});
}

void sum_job_counts(ServerConnection& server) {
    server.run("WITH summed AS (DELETE FROM macadam.job_count WHERE ctid = ANY(ARRAY("
               "SELECT ctid FROM macadam.job_count"
               " WHERE (SELECT count(*) FROM macadam.job_count) > 100 FOR UPDATE SKIP LOCKED))"
               " RETURNING state, logs)"
               " INSERT INTO macadam.job_count SELECT state, sum(logs)::bigint FROM summed"
               " GROUP BY state");
}

std::vector<Job> end_forgotten_jobs(ServerConnection& server) {
    return jobs_in(server.rows(fmt::format(
        "WITH ending AS (SELECT sha256 FROM macadam.job WHERE sha256 IN"
        " (SELECT job FROM macadam.forgotten JOIN macadam.job_trip ON {} = mark"
        " UNION SELECT sha256 FROM macadam.forgotten JOIN macadam.job ON {} = mark)"
        " ORDER BY sha256 FOR UPDATE)"
        " UPDATE macadam.job SET state = 'known', finished_at = now(), lease_until = NULL,"
        " worker = NULL, has_object = true, not_before = now(), reason = '{}'"
        " FROM ending WHERE job.sha256 = ending.sha256 RETURNING job.{}",
        mark_expression("trip"),
        mark_expression("sha256"),
        forgotten_reason,
        job_columns)));
}

void remove_forgotten_jobs(ServerConnection& server, std::span<const Job> jobs) {
    server.rows(fmt::format("WITH ended AS (SELECT sha256 FROM macadam.job"
                            " WHERE sha256 = ANY($1) {} ORDER BY sha256 FOR UPDATE)"
                            " DELETE FROM macadam.job USING ended"
                            " WHERE job.sha256 = ended.sha256",
                            was_forgotten),
                {hashes_of(jobs)});
}

} // namespace macadam
