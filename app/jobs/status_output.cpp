#include "app/jobs/status_output.hpp"

#include "app/cli/console.hpp"
#include "app/cli/text_table.hpp"
#include "storage/text/json.hpp"
#include "storage/text/utc.hpp"
#include "storage/uploads/upload_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace macadam {
namespace {

const Columns<WorkerStatus> worker_columns{
    {"name", as::text, [](auto& r) { return r.name; }, {"worker", "{:<32}"}},
    {"alive", as::truth, [](auto& r) { return r.is_alive; }},
    {"", as::text, [](auto& r) { return r.is_alive ? "yes" : "no"; }, {"alive", " {:>5}"}},
    {"version", as::integer, [](auto& r) { return r.results_version; }},
    {"seen_s", as::seconds(1), [](auto& r) { return r.seen_s; }, {"seen s", " {:>8}"}},
    {"jobs", as::integer, [](auto& r) { return r.jobs; }, {"jobs", " {:>5}"}},
    {"working", as::integer, [](auto& r) { return r.working; }, {"working", " {:>8}"}},
    {"finished", as::integer, [](auto& r) { return r.finished; }, {"finished", " {:>9}"}},
};

const Columns<FailedLog> failed_columns{
    {"sha256", as::text, [](auto& r) { return r.sha256; }},
    {"", as::text, [](auto& r) { return r.sha256.substr(0, 12); }, {"log", "{:<12}"}},
    {"state", as::text, [](auto& r) { return r.state; }, {"state", "  {:<8}"}},
    {"attempts", as::integer, [](auto& r) { return r.attempts; }, {"attempts", " {:>8}"}},
    {"at", as::text, [](auto& r) { return known_if(r.finished_ms > 0, utc_text(r.finished_ms)); }},
    {"reason", as::text, [](auto& r) { return r.reason; }, {"reason", "  {}"}},
};

std::int64_t waiting(const WorkStatus& status) {
    return status.logs.at("queued") + status.logs.at("working");
}

std::int64_t alive(const WorkStatus& status) {
    return std::ranges::count_if(status.workers, &WorkerStatus::is_alive);
}

/// "0 s", "3 min", "2 h": how long the oldest log waits.
std::string lag_text(double seconds) {
    constexpr double s_per_min = 60, s_per_h = 3600, s_per_day = 86'400;
    return seconds < 2 * s_per_min   ? fmt::format("{:.0f} s", seconds)
           : seconds < 2 * s_per_h   ? fmt::format("{:.0f} min", seconds / s_per_min)
           : seconds < 2 * s_per_day ? fmt::format("{:.0f} h", seconds / s_per_h)
                                     : fmt::format("{:.0f} days", seconds / s_per_day);
}

} // namespace

std::string status_text(const WorkStatus& status) {
    std::string text;
    for (const auto state : all_upload_states) {
        const auto name = std::string{name_of(state)};
        text += fmt::format("{:<9} {:>9}\n", name, status.logs.at(name));
    }
    text += fmt::format("\noldest waits for {}; {} finished in the last minute, {} in the last "
                        "hour ({} passes); {}{} to be fused\n",
                        lag_text(status.oldest_s),
                        status.finished_in_minute,
                        status.finished_in_hour,
                        status.passes_in_hour,
                        status.chunks_to_fuse == max_chunks_counted ? "at least " : "",
                        counted(static_cast<std::size_t>(status.chunks_to_fuse), "chunk"));
    text += fmt::format("objects in {}\n", status.objects.value_or("no store so far"));
    text +=
        status.workers.empty() ? "no worker\n" : "\n" + table_text(worker_columns, status.workers);
    if (!status.failed.empty()) {
        text += "\n" + table_text(failed_columns, status.failed);
    }
    return text;
}

std::string status_json(const WorkStatus& status) {
    JsonObject logs;
    for (const auto& [name, count] : status.logs) {
        logs.add(name, count);
    }
    JsonObject object;
    object.add("logs", JsonRaw{logs.text()})
        .add("oldest_s", json_number(status.oldest_s, 1))
        .add("accepted_in_minute", status.accepted_in_minute)
        .add("accepted_in_hour", status.accepted_in_hour)
        .add("finished_in_minute", status.finished_in_minute)
        .add("finished_in_hour", status.finished_in_hour)
        .add("passes_in_hour", status.passes_in_hour)
        .add("chunks_to_fuse", status.chunks_to_fuse)
        .add("objects", status.objects ? JsonValue{*status.objects} : JsonValue{nullptr})
        .add("workers", JsonRaw{json_rows(worker_columns, status.workers)})
        .add("failed", JsonRaw{json_rows(failed_columns, status.failed)});
    return object.text();
}

std::string status_metrics(const WorkStatus& status) {
    std::string text = "# TYPE macadam_queue_logs gauge\n";
    for (const auto& [name, count] : status.logs) {
        text += fmt::format("macadam_queue_logs{{state=\"{}\"}} {}\n", name, count);
    }
    std::int64_t finished = 0;
    for (const auto& [name, count] : status.logs) {
        finished += count;
    }
    finished -= waiting(status);
    return text + fmt::format("# TYPE macadam_queue_finished_total counter\n"
                              "macadam_queue_finished_total {}\n"
                              "# TYPE macadam_queue_oldest_seconds gauge\n"
                              "macadam_queue_oldest_seconds {:.1f}\n"
                              "# TYPE macadam_queue_chunks_to_fuse gauge\n"
                              "macadam_queue_chunks_to_fuse {}\n"
                              "# TYPE macadam_queue_workers gauge\n"
                              "macadam_queue_workers {}\n",
                              finished,
                              status.oldest_s,
                              status.chunks_to_fuse,
                              alive(status));
}

} // namespace macadam
