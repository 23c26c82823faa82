#pragma once

#include "storage/postgres/server_connection.hpp"
#include "storage/uploads/upload_state.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

// Queue of trip logs on a server, for workers on any machine: table macadam.job. The clock is the
// server's alone.

/// Log, or archive of logs, that was submitted. Its bytes are in an object store.
struct Job {
    std::string sha256; ///< of the bytes
    std::string suffix; ///< of the file, by which the format is known: ".trip.csv"
    std::int64_t bytes = 0;
    int attempts = 0;       ///< times that a worker has begun it
    bool was_begun = false; ///< before this attempt, also by one that does not count
};

/// Attempts after which a job is parked.
inline constexpr int max_job_attempts = 5;

enum class Submission : std::uint8_t {
    added,    ///< new
    requeued, ///< had been refused, parked or outside the map: tried again
    known     ///< waits, or is done
};

/// State of each log that is known.
std::vector<std::optional<UploadState>> states_of_logs(ServerConnection& server,
                                                       std::span<const Job> logs);

/// Array of PostgreSQL of the hashes of logs.
std::string hashes_of(std::span<const Job> jobs);

/// Queues logs whose objects are stored, in one transaction, and ends their announcements
/// (announced_logs.hpp). A standby has them, too, when this returns, also those that are known.
/// \param logs  without repetitions
/// \param objects  location of their objects; "" = that of the workers, whichever it is
/// \param owner    who sent them by a token; "" = they are submitted
/// \returns for each what it was.
///
/// \throws InputError  if workers look for them elsewhere, or one that is not known was announced
///                     over a day ago, or never: nothing is queued, store and submit them again;
///                     also if the commit is in doubt: then submit them again.
std::vector<Submission> submit_logs(ServerConnection& server,
                                    std::span<const Job> logs,
                                    const std::string& objects = {},
                                    const std::string& owner = {});

/// Queues all parked logs again, whose objects are still stored. \returns their number.
std::size_t submit_parked_logs(ServerConnection& server);

/// Worker that takes jobs.
struct JobTaker {
    std::string worker; ///< its name
    std::chrono::seconds lease{60};
};

/// Takes jobs that wait, or whose worker is dead, in a transaction of its own: their attempts count
/// even if the caller is killed at once. Of jobs that were begun before, as one of them may have
/// ended its worker, fewer are taken together after each attempt, and the last time one alone.
/// Those that were begun five times are parked.
///
/// \param first_retries  takes jobs that were begun before, if one is due, before new ones
std::vector<Job>
take_jobs(ServerConnection& server, const JobTaker& taker, std::size_t at_most, bool first_retries);

/// End of a job: its state and the reason.
struct JobEnd {
    Job job;
    UploadState state = UploadState::imported;
    std::string reason{};
    std::int64_t passes = 0;
    std::vector<std::string> trips{}; ///< SHA-256 of those of its trips that are stored
    std::vector<std::string> own{};   ///< of these, imported from it, now or by an earlier attempt
};

/// Records ends, in one transaction. Those of jobs that another worker has taken meanwhile are left
/// to it. \returns the number recorded.
std::size_t
finish_jobs(ServerConnection& server, const JobTaker& taker, std::span<const JobEnd> ends);

/// Gives a job back that failed for a reason that may pass: for a later attempt or, after the
/// fifth, parked.
void fail_job(ServerConnection& server,
              const JobTaker& taker,
              const Job& job,
              const std::string& reason);

/// Gives jobs back that were not tried: these attempts do not count.
/// \param pause  before which nobody takes them again
void put_back_jobs(ServerConnection& server,
                   const JobTaker& taker,
                   std::span<const Job> jobs,
                   std::chrono::seconds pause = {});
/// The same for all jobs of a worker that works on none: it could not give them back as its
/// connection broke, and its heartbeat, which has another, keeps others from taking them.
void put_back_all(ServerConnection& server, const JobTaker& taker);

/// Which logs leave the object store once they are done.
enum class ErasedLogs : std::uint8_t {
    imported,   ///< or known
    worked_out, ///< also those that are refused or outside the map
    forgotten   ///< those with a trip that was permanently deleted
};

/// Jobs that are done and whose objects are still stored, at most `limit`. Locks them until the end
/// of the transaction, in which the caller is to note that the objects are gone, and then to remove
/// them: who submits such a log again waits for that.
std::vector<Job> jobs_to_erase(ServerConnection& server, std::size_t limit, ErasedLogs which);
/// Notes that their objects are gone.
void note_erased(ServerConnection& server, std::span<const Job> jobs);

/// Removes jobs that were done over 400 days ago and whose objects are gone, at most `limit`. A log
/// that is submitted again then is worked out again, and found to be known.
void remove_old_jobs(ServerConnection& server, std::size_t limit);

/// Adds up the rows by which finished logs are counted, once there are many.
void sum_job_counts(ServerConnection& server);

/// Ends jobs of logs that are, or hold, a trip which was permanently deleted, whatever they wait
/// for. \returns them; their objects are to be erased.
std::vector<Job> end_forgotten_jobs(ServerConnection& server);
/// Removes jobs that were ended so, once their objects are gone.
void remove_forgotten_jobs(ServerConnection& server, std::span<const Job> jobs);

} // namespace macadam
