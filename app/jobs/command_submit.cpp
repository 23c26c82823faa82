#include "app/cli/server_commands.hpp"
#include "app/jobs/job_options.hpp"
#include "app/jobs/submitted_logs.hpp"
#include "app/parallel/jobs_option.hpp"
#include "app/parallel/parallel_for.hpp"

#include "estimator/common/error.hpp"
#include "storage/jobs/announced_logs.hpp"
#include "storage/jobs/worker_register.hpp"
#include "storage/objects/object_store.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

/// Logs that are stored and queued together: one commit each.
constexpr std::size_t batch_size = 100;

struct Counts {
    std::size_t added = 0, requeued = 0, known = 0, failed = 0;
};

class Submitting {
public:
    Submitting(const Arguments& arguments, const Console& console)
        : console_{console}, server_{opened_server(server_of(arguments))}, objects_{objects_of(
                                                                               arguments, server_)},
          jobs_{jobs_of(arguments)}, is_json_{arguments.flag("--json")} {
        // Before anything is queued: a wrong store must not become that of the workers.
        stores_.push_back(open_object_store(objects_, console.stop()));
        while (stores_.size() < jobs_) {
            stores_.push_back(open_object_store(objects_, console.stop()));
        }
    }

    Counts run(std::vector<SubmittedLog> logs) {
        const auto progress = console_.progress("submitting", {.name = "log"});
        put_objects_location(server_, objects_);
        for (std::size_t begin = 0; begin < logs.size(); begin += batch_size) {
            if (console_.stop().stop_requested()) {
                throw InputError{fmt::format("interrupted: {} of {} were not submitted; run the "
                                             "same command again to continue",
                                             logs.size() - begin,
                                             counted(logs.size(), "log"))};
            }
            submit(std::span{logs}.subspan(begin, std::min(batch_size, logs.size() - begin)));
            progress(std::min(begin + batch_size, logs.size()), logs.size());
        }
        return counts_;
    }

private:
    /// Calls for each log on several threads, which share the stores; an error is the log's alone.
    template <typename Work>
    void for_each(std::vector<SubmittedLog*>& logs, Work work) {
        const std::size_t lanes = std::min(jobs_, logs.size());
        parallel_for(lanes, lanes, [&](std::size_t lane) {
            for (std::size_t i = lane; i < logs.size(); i += lanes) {
                try {
                    work(*logs[i], *stores_[lane]);
                } catch (const InputError& error) {
                    logs[i]->refusal = error.what();
                }
            }
        });
        std::erase_if(logs, [](const auto* log) { return !log->refusal.empty(); });
    }

    void submit(std::span<SubmittedLog> batch) {
        std::vector<SubmittedLog*> logs;
        for (auto& log : batch) {
            if (log.refusal.empty()) {
                logs.push_back(&log);
            }
        }
        for_each(logs, [](SubmittedLog& log, ObjectStore&) { log.job = job_of(log.file); });
        auto unique = logs; // the same bytes may come under two names
        std::ranges::sort(unique, {}, [](const auto* log) { return log->job.sha256; });
        const auto rest =
            std::ranges::unique(unique, {}, [](const auto* log) { return log->job.sha256; });
        unique.erase(rest.begin(), rest.end());
        const auto states = states_of_logs(server_, jobs_in(unique));
        std::vector<SubmittedLog*> missing;
        for (std::size_t i = 0; i < unique.size(); ++i) {
            if (!states[i] || is_tried_again(*states[i])) {
                missing.push_back(unique[i]);
            }
        }
        announce_logs(server_, jobs_in(missing), objects_);
        for_each(missing, [](SubmittedLog& log, ObjectStore& store) {
            store.put({log.job.sha256, log.job.bytes}, log.file);
        });
        std::erase_if(unique, [](const auto* log) { return !log->refusal.empty(); });
        const auto results = submit_logs(server_, jobs_in(unique), objects_);
        tell(batch, unique, results);
    }

    static std::vector<Job> jobs_in(const std::vector<SubmittedLog*>& logs) {
        std::vector<Job> jobs;
        for (const auto* log : logs) {
            jobs.push_back(log->job);
        }
        return jobs;
    }

    void tell(std::span<const SubmittedLog> batch,
              const std::vector<SubmittedLog*>& unique,
              const std::vector<Submission>& results) {
        for (const auto& log : batch) {
            if (!log.refusal.empty()) {
                ++counts_.failed;
                report(log, "failed");
                continue;
            }
            const auto found = std::ranges::find(unique, &log);
            const auto result = found == unique.end()
                                    ? Submission::known
                                    : results[static_cast<std::size_t>(found - unique.begin())];
            counts_.added += result == Submission::added ? 1U : 0U;
            counts_.requeued += result == Submission::requeued ? 1U : 0U;
            counts_.known += result == Submission::known ? 1U : 0U;
            report(log,
                   result == Submission::added      ? "new"
                   : result == Submission::requeued ? "again"
                                                    : "known");
        }
    }

    void report(const SubmittedLog& log, std::string_view result) const {
        if (is_json_) {
            JsonObject object;
            object.add("file", log.file.string())
                .add("result", std::string{result})
                .add("sha256", log.job.sha256.empty() ? JsonValue{nullptr} : log.job.sha256)
                .add("error", log.refusal.empty() ? JsonValue{nullptr} : log.refusal);
            print(object.text() + "\n");
        } else if (!log.refusal.empty()) {
            console_.warn(log.refusal);
        } else if (!console_.is_quiet()) {
            print_words(fmt::format("{:<5}  {}\n", result, log.file.string()));
        }
    }

    const Console& console_;
    ServerConnection server_;
    std::string objects_;
    std::size_t jobs_;
    bool is_json_;
    std::vector<std::unique_ptr<ObjectStore>> stores_; ///< one for each thread
    Counts counts_;
};

void submit_again(const Arguments& arguments, const Console& console) {
    for (const std::string name : {"--objects", "--jobs", "--json"}) {
        if (arguments.is_given(name)) {
            throw UsageError{fmt::format("--again takes parked logs from where they are stored, "
                                         "expected no {}",
                                         name)};
        }
    }
    auto server = opened_server(server_of(arguments));
    console.say(fmt::format("{} submitted again; 'macadam status' follows them",
                            counted(submit_parked_logs(server), "parked log")));
}

void run_submit(const Arguments& arguments, const Console& console) {
    const auto& paths = arguments.operands("PATH");
    if (arguments.flag("--again") != paths.empty()) {
        throw UsageError{paths.empty() ? "PATH is missing, expected logs, or --again for those "
                                         "that are parked"
                                       : "--again submits the logs that are parked, expected no "
                                         "PATH"};
    }
    if (paths.empty()) {
        submit_again(arguments, console);
        return;
    }
    Submitting submitting{arguments, console};
    auto logs = logs_to_submit(paths, console);
    if (logs.empty()) {
        throw InputError{"no trip log was found: nothing was submitted"};
    }
    const auto asked = logs.size();
    const auto counts = submitting.run(std::move(logs));
    console.say(fmt::format("{} submitted, {} again, {} already known{}; 'macadam status' follows "
                            "them",
                            counted(counts.added, "log"),
                            counts.requeued,
                            counts.known,
                            counts.failed > 0 ? fmt::format(", {} failed", counts.failed) : ""));
    if (counts.failed > 0) {
        throw InputError{fmt::format("{} of {} could not be submitted{}",
                                     counts.failed,
                                     counted(asked, "log"),
                                     counts.failed < asked ? "; the others are queued" : "")};
    }
}

constexpr std::array operands{
    server_operand,
    Operand{.name = "PATH",
            .help =
                "Trip logs, archives (.zip, .tar.gz), or folders containing them (at any depth).",
            .many = true,
            .optional = true}};
constexpr std::array options{
    objects_option,
    preference({"--jobs", "N", "Number of logs sent in parallel.", default_jobs_words}),
    Option{"--again", "", "Submit all parked logs again, from the object store; without PATH."},
    Option{"--json", "", "One JSON object per log on standard output, one per line."}};

} // namespace

const Command submit_command{
    .name = "submit",
    .summary = "Queue trip logs for the workers of a database on a server",
    .about =
        "Stores each log in an object store, under the SHA-256 of its bytes, and queues it. A log "
        "reported as new is on\n"
        "disk in both and will be imported once, whatever is killed; one that was submitted "
        "before is skipped, unless it was\n"
        "refused or parked: then it is tried again. 'macadam worker' imports what waits, 'macadam "
        "status' tells what became of\n"
        "it. Parked logs need not be sent again: --again queues all of them.\n"
        "Keys of a bucket come from AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY or "
        "~/.aws/credentials, its service from\n"
        "AWS_ENDPOINT_URL and AWS_REGION.",
    .example = "  macadam submit postgresql://me@db.example.org/roads trips/ --objects "
               "/srv/roads/logs\n"
               "  macadam submit postgresql://me@db.example.org/roads a.trip.csv.gz --objects "
               "s3://roads/logs\n"
               "  macadam submit postgresql://me@db.example.org/roads --again",
    .operands = operands,
    .options = options,
    .run = run_submit};

} // namespace macadam
