#include "storage/jobs/work_status.hpp"

#include "estimator/common/exact_number.hpp"
#include "storage/jobs/worker_register.hpp"
#include "storage/text/text.hpp"
#include "storage/uploads/upload_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace macadam {
namespace {

std::int64_t integer_in(const std::optional<std::string>& text) {
    return text ? exact_number<std::int64_t>(*text).value_or(0) : 0;
}

double real_in(const std::optional<std::string>& text) {
    return text ? parse_number(*text).value_or(0) : 0;
}

void add_counts(WorkStatus& status, ServerConnection& server) {
    for (const auto state : all_upload_states) {
        status.logs[std::string{name_of(state)}] = 0;
    }
    for (const auto& row :
         server.rows("SELECT state, sum(logs) FROM macadam.job_count GROUP BY state")) {
        status.logs[row[0].value_or("")] = integer_in(row[1]);
    }
    for (const auto& row :
         server.rows("SELECT state, count(*), extract(epoch FROM now() - min(submitted_at))"
                     " FROM macadam.job WHERE state IN ('queued', 'working', 'parked', 'refused')"
                     " GROUP BY state")) {
        const auto state = state_named(row[0].value_or(""));
        status.logs[std::string{name_of(state)}] = integer_in(row[1]);
        if (is_waiting(state)) {
            status.oldest_s = std::max(status.oldest_s, real_in(row[2]));
        }
    }
    const auto accepted = server.rows(
        "SELECT count(*) FILTER (WHERE submitted_at > now() - interval '1 min'), count(*)"
        " FROM macadam.job WHERE submitted_at > now() - interval '1 hour'");
    status.accepted_in_minute = integer_in(accepted.at(0)[0]);
    status.accepted_in_hour = integer_in(accepted.at(0)[1]);
    const auto rates = server.rows(
        "SELECT count(*) FILTER (WHERE finished_at > now() - interval '1 min'), count(*),"
        " sum(passes) FROM macadam.job WHERE finished_at > now() - interval '1 hour'");
    status.finished_in_minute = integer_in(rates.at(0)[0]);
    status.finished_in_hour = integer_in(rates.at(0)[1]);
    status.passes_in_hour = integer_in(rates.at(0)[2]);
    status.chunks_to_fuse =
        server.number(fmt::format("SELECT count(*) FROM (SELECT DISTINCT chunk"
                                  " FROM macadam.chunk_dirty ORDER BY chunk LIMIT {}) AS marked",
                                  max_chunks_counted));
}

void add_workers(WorkStatus& status, ServerConnection& server) {
    for (const auto& row : server.rows(
             "SELECT name, seen_at > now() - lease_s * interval '1 s', results_version, jobs,"
             " (SELECT count(*) FROM macadam.job WHERE state = 'working' AND job.worker = name),"
             " finished, extract(epoch FROM now() - seen_at) FROM macadam.worker ORDER BY name")) {
        status.workers.push_back({.name = row[0].value_or(""),
                                  .is_alive = row[1] == "t",
                                  .results_version = integer_in(row[2]),
                                  .jobs = integer_in(row[3]),
                                  .working = integer_in(row[4]),
                                  .finished = integer_in(row[5]),
                                  .seen_s = real_in(row[6])});
    }
}

void add_failed(WorkStatus& status, ServerConnection& server, std::size_t most) {
    for (const auto& row :
         server.rows("SELECT sha256, state, reason, attempts,"
                     " floor(extract(epoch FROM finished_at) * 1000)::bigint FROM macadam.job"
                     " WHERE state IN ('parked', 'refused') ORDER BY state, number DESC LIMIT $1",
                     {std::to_string(most)})) {
        status.failed.push_back({.sha256 = row[0].value_or(""),
                                 .state = row[1].value_or(""),
                                 .reason = row[2].value_or(""),
                                 .attempts = integer_in(row[3]),
                                 .finished_ms = integer_in(row[4])});
    }
}

} // namespace

bool may_read_work(ServerConnection& server) {
    return server.number("SELECT has_table_privilege('macadam.job', 'SELECT')::integer") != 0;
}

WorkStatus work_status(ServerConnection& server, std::size_t max_failed) {
    const ServerTransaction one_moment{server, true};
    WorkStatus status;
    add_counts(status, server);
    add_workers(status, server);
    add_failed(status, server, max_failed);
    status.objects = objects_location(server);
    return status;
}

std::int64_t last_log_number(ServerConnection& server) {
    return server.number("SELECT coalesce(max(number), 0) FROM macadam.job");
}

Backlog backlog_up_to(ServerConnection& server, std::int64_t last) {
    const auto row =
        server
            .rows("SELECT (SELECT count(*) FROM macadam.job WHERE state IN ('queued', 'working')"
                  " AND number <= $1::bigint), EXISTS (SELECT FROM macadam.job"
                  " WHERE state = 'working' AND number <= $1::bigint AND lease_until > now()),"
                  " (SELECT max(lease_s) FROM macadam.worker"
                  " WHERE seen_at > now() - lease_s * interval '1 s')",
                  {std::to_string(last)})
            .at(0);
    Backlog backlog{.waiting = integer_in(row[0]), .is_worked_on = row[1] == "t", .lease = {}};
    if (row[2]) {
        backlog.lease = std::chrono::seconds{integer_in(row[2])};
    }
    return backlog;
}

} // namespace macadam
