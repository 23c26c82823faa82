#include "storage/uploads/upload_queue.hpp"

#include <set>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace macadam {
namespace {

namespace fs = std::filesystem;

const std::string select_uploads =
    "SELECT sha256, owner, suffix, bytes, received_ms, state, attempts, deleting, reason,"
    " (SELECT count(*) FROM upload_trip WHERE upload = number),"
    " (SELECT coalesce(sum(passes), 0) FROM upload_trip WHERE upload = number) FROM upload ";

Upload upload_in(const Statement& row) {
    return {.sha256 = row.text(0),
            .owner = row.text(1),
            .suffix = row.text(2),
            .bytes = row.integer(3),
            .received_ms = row.integer(4),
            .state = state_named(row.text(5)),
            .attempts = static_cast<int>(row.integer(6)),
            .deleting = row.integer(7) != 0,
            .reason = row.text(8),
            .trips = static_cast<std::size_t>(row.integer(9)),
            .passes = row.integer(10)};
}

/// Opens and locks a file of the spool; -1 if it has gone or another program works on it.
int locked(const fs::path& file) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    struct stat open {};
    struct stat named {};
    if (descriptor >= 0 &&
        (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 || ::fstat(descriptor, &open) != 0 ||
         ::stat(file.c_str(), &named) != 0 || open.st_ino != named.st_ino)) {
        ::close(descriptor);
        return -1;
    }
    return descriptor;
}

/// Row of the upload: a subquery for statements about its trips.
constexpr const char* insert_trip =
    "INSERT INTO upload_trip SELECT ?1, ?2, number FROM upload WHERE sha256 = ?3"
    " ON CONFLICT DO NOTHING";

} // namespace

std::optional<Upload> find_upload(Database& uploads, std::string_view sha256) {
    auto row = uploads.prepare(select_uploads + "WHERE sha256 = ?");
    return row.bind(sha256).step() ? std::optional{upload_in(row)} : std::nullopt;
}

std::vector<Upload> latest_uploads(Database& uploads, std::string_view owner, std::size_t limit) {
    auto row =
        uploads.prepare(select_uploads + (owner.empty() ? "WHERE ?1 = ''" : "WHERE owner = ?1") +
                        " ORDER BY number DESC LIMIT ?2");
    row.bind(owner, static_cast<std::int64_t>(limit));
    std::vector<Upload> found;
    while (row.step()) {
        found.push_back(upload_in(row));
    }
    return found;
}

std::size_t count_waiting(Database& uploads) {
    return static_cast<std::size_t>(uploads.number(
        "SELECT count(*) FROM upload WHERE deleting = 1 OR state IN ('queued', 'working')"));
}

bool enqueue(Database& uploads, AtomicFile& file, const Upload& upload) {
    // A sweep waits for this transaction, so that it takes away no file without a row.
    Transaction one{uploads, Transaction::Kind::write};
    if (const auto known = find_upload(uploads, upload.sha256)) {
        const bool is_to_retry =
            is_tried_again(known->state) && known->owner == upload.owner && !known->deleting;
        if (!is_to_retry) {
            return false;
        }
        uploads.prepare("DELETE FROM upload WHERE sha256 = ?").run(upload.sha256);
    }
    file.commit();
    uploads
        .prepare("INSERT INTO upload (sha256, owner, suffix, bytes, received_ms, state)"
                 " VALUES (?, ?, ?, ?, ?, 'queued')")
        .run(upload.sha256, upload.owner, upload.suffix, upload.bytes, upload.received_ms);
    one.commit();
    return true;
}

bool delete_upload(Database& uploads, const fs::path& spool, std::string_view sha256) {
    Transaction one{uploads, Transaction::Kind::write};
    const auto upload = find_upload(uploads, sha256);
    if (!upload) {
        return true;
    }
    const auto file = upload->file_in(spool);
    const int lock = is_waiting(upload->state) ? locked(file) : -1;
    // A log that was begun before a kill may have its trips in the database already.
    const bool is_untouched =
        is_waiting(upload->state) ? lock >= 0 && upload->attempts == 0 : upload->trips == 0;
    uploads
        .prepare(is_untouched ? "DELETE FROM upload WHERE sha256 = ?"
                              : "UPDATE upload SET deleting = 1 WHERE sha256 = ?")
        .run(sha256);
    one.commit();
    if (is_untouched && lock >= 0) {
        ::unlink(file.c_str());
    }
    if (lock >= 0) {
        ::close(lock);
    }
    return is_untouched;
}

TakenUpload::TakenUpload(TakenUpload&& other) noexcept
    : upload_{std::move(other.upload_)}, lock_{std::exchange(other.lock_, -1)} {}

TakenUpload::~TakenUpload() {
    if (lock_ >= 0) {
        ::close(lock_);
    }
}

std::vector<TakenUpload>
take_uploads(Database& uploads, const fs::path& spool, std::size_t at_most, int max_begun) {
    std::vector<TakenUpload> taken;
    Transaction one{uploads, Transaction::Kind::write};
    auto row =
        uploads.prepare(select_uploads + "WHERE state IN ('queued', 'working') AND attempts <= ?"
                                         " ORDER BY attempts > 0, number");
    row.bind(max_begun);
    std::vector<Upload> waiting;
    while (row.step()) {
        waiting.push_back(upload_in(row));
    }
    for (auto& upload : waiting) {
        const bool was_begun = upload.attempts > 0;
        if (taken.size() >= at_most || (was_begun && !taken.empty())) {
            break;
        }
        const int lock = locked(upload.file_in(spool));
        if (lock < 0) {
            // Its row comes after its file, and goes before it: it was taken away by other means.
            if (fs::is_directory(spool) && !fs::exists(upload.file_in(spool))) {
                uploads.prepare("UPDATE upload SET state = ?, reason = ? WHERE sha256 = ?")
                    .run(name_of(UploadState::refused), "the log is missing", upload.sha256);
            }
            continue;
        }
        ++upload.attempts;
        uploads.prepare("UPDATE upload SET state = 'working', attempts = ? WHERE sha256 = ?")
            .run(upload.attempts, upload.sha256);
        taken.emplace_back(std::move(upload), lock);
        if (was_begun) {
            break;
        }
    }
    one.commit();
    return taken;
}

void add_trip_of(Database& uploads,
                 const Upload& upload,
                 const std::string& sha256,
                 std::int64_t passes) {
    uploads.prepare(insert_trip).run(sha256, passes, upload.sha256);
}

std::vector<std::string> trips_of(Database& uploads, const Upload& upload) {
    std::vector<std::string> trips;
    auto trip = uploads.prepare("SELECT upload_trip.sha256 FROM upload_trip"
                                " JOIN upload ON number = upload WHERE upload.sha256 = ?");
    for (trip.bind(upload.sha256); trip.step();) {
        trips.push_back(trip.text(0));
    }
    return trips;
}

bool is_trip_of(Database& uploads, const Upload& upload, const std::string& sha256) {
    auto row = uploads.prepare("SELECT 1 FROM upload_trip JOIN upload ON number = upload"
                               " WHERE upload_trip.sha256 = ? AND upload.sha256 = ?");
    return row.bind(sha256, upload.sha256).step();
}

bool is_trip_of_any(Database& uploads, const std::string& sha256) {
    auto row = uploads.prepare("SELECT 1 FROM upload_trip WHERE sha256 = ?");
    return row.bind(sha256).step();
}

void finish_upload(Database& uploads,
                   const fs::path& spool,
                   const Upload& upload,
                   UploadState state,
                   const std::string& reason) {
    uploads.prepare("UPDATE upload SET state = ?, reason = ? WHERE sha256 = ?")
        .run(name_of(state), reason, upload.sha256);
    ::unlink(upload.file_in(spool).c_str()); // not before: without it, the log would be lost
}

void put_back(Database& uploads, const Upload& upload) {
    uploads.prepare("UPDATE upload SET state = 'queued', attempts = ? WHERE sha256 = ?")
        .run(upload.attempts - 1, upload.sha256);
}

std::optional<Deletion> next_deletion(Database& uploads) {
    auto row =
        uploads.prepare(select_uploads + "WHERE deleting = 1 AND state NOT IN ('queued', 'working')"
                                         " ORDER BY number LIMIT 1");
    if (!row.bind().step()) {
        return std::nullopt;
    }
    Deletion deletion{.upload = upload_in(row), .trips = {}};
    deletion.trips = trips_of(uploads, deletion.upload);
    return deletion;
}

void finish_deletion(Database& uploads, const Upload& upload) {
    uploads.prepare("DELETE FROM upload WHERE sha256 = ?").run(upload.sha256);
}

void drop_missing_trips(Database& uploads,
                        const std::function<bool(const std::string& sha256)>& is_stored) {
    Transaction one{uploads, Transaction::Kind::write};
    std::vector<std::string> missing;
    auto row = uploads.prepare("SELECT sha256 FROM upload_trip");
    while (row.step()) {
        if (auto trip = row.text(0); !is_stored(trip)) {
            missing.push_back(std::move(trip));
        }
    }
    row.reset();
    for (const auto& trip : missing) {
        uploads.prepare("DELETE FROM upload_trip WHERE sha256 = ?").run(trip);
    }
    uploads.run("DELETE FROM upload WHERE state = 'imported' AND NOT EXISTS"
                " (SELECT 1 FROM upload_trip WHERE upload = number)");
    one.commit();
}

WorkerMark::WorkerMark(const fs::path& spool)
    : lock_{::open(spool.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)} {
    if (lock_ >= 0) {
        ::flock(lock_, LOCK_SH | LOCK_NB);
    }
}

WorkerMark::~WorkerMark() {
    if (lock_ >= 0) {
        ::close(lock_);
    }
}

bool WorkerMark::is_set(const fs::path& spool) {
    const int lock = ::open(spool.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool is_taken = lock >= 0 && ::flock(lock, LOCK_EX | LOCK_NB) != 0;
    if (lock >= 0) {
        ::close(lock);
    }
    return is_taken;
}

void sweep_spool(Database& uploads, const fs::path& spool) {
    const Transaction no_upload_comes{uploads, Transaction::Kind::write};
    auto row = uploads.prepare(select_uploads + "WHERE state IN ('queued', 'working')");
    std::set<fs::path> waiting;
    while (row.step()) {
        waiting.insert(upload_in(row).file_in(spool));
    }
    std::error_code gone;
    std::vector<fs::path> others;
    for (fs::directory_iterator file{spool, gone}, end; !gone && file != end;
         file.increment(gone)) {
        if (file->is_regular_file(gone) && !waiting.contains(file->path())) {
            others.push_back(file->path());
        }
    }
    for (const auto& file : others) {
        fs::remove(file, gone);
    }
}

} // namespace macadam
