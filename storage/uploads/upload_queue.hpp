#pragma once

#include "storage/atomic/atomic_file.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/uploads/upload_state.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

/// Log, or archive of logs, that a contributor has sent.
struct Upload {
    std::string sha256; ///< of the bytes sent
    std::string owner;
    std::string suffix; ///< of its file, by which the format is known: ".trip.csv"
    std::int64_t bytes = 0;
    std::int64_t received_ms = 0; ///< ms since 1970 UTC
    UploadState state = UploadState::queued;
    int attempts = 0;      ///< times that a worker has begun it
    bool deleting = false; ///< its trips are to be forgotten
    std::string reason{};  ///< for which it was refused, or is known
    std::size_t trips = 0; ///< imported from it
    std::int64_t passes = 0;

    std::filesystem::path file_in(const std::filesystem::path& spool) const {
        return spool / (sha256 + suffix);
    }
};

std::optional<Upload> find_upload(Database& uploads, std::string_view sha256);

/// Latest uploads of an owner, or of all for "", newest first, at most `limit`.
std::vector<Upload> latest_uploads(Database& uploads, std::string_view owner, std::size_t limit);

std::size_t count_waiting(Database& uploads);

/// Commits a log to the spool and adds it to the queue: when this returns true, neither a kill nor
/// a loss of power loses it. One that was refused or outside the map is tried again.
/// \returns false if it is known; the file then vanishes.
bool enqueue(Database& uploads, AtomicFile& file, const Upload& upload);

/// Removes an upload that no trip of the road database came from, or marks its trips to be
/// forgotten by a worker.
/// \returns true if nothing is left of it.
bool delete_upload(Database& uploads, const std::filesystem::path& spool, std::string_view sha256);

/// Upload that this process works on, for as long as the object lives; a lock of its file tells
/// other processes, and is released by the kernel after a kill.
class TakenUpload {
public:
    TakenUpload(Upload upload, int descriptor) : upload_{std::move(upload)}, lock_{descriptor} {}
    TakenUpload(TakenUpload&& other) noexcept;
    TakenUpload& operator=(TakenUpload&&) = delete;
    ~TakenUpload();

    const Upload& upload() const { return upload_; }

private:
    Upload upload_;
    int lock_;
};

/// Takes the oldest uploads that wait. Those that were begun before come last and each alone,
/// because they may have ended the program.
/// \param max_begun  leaves those that were begun more often
std::vector<TakenUpload> take_uploads(Database& uploads,
                                      const std::filesystem::path& spool,
                                      std::size_t at_most,
                                      int max_begun = std::numeric_limits<int>::max());

/// Notes that a trip of the road database came from an upload, unless it came from another.
void add_trip_of(Database& uploads,
                 const Upload& upload,
                 const std::string& sha256,
                 std::int64_t passes);

/// Hashes of the trips that are noted as those of an upload.
std::vector<std::string> trips_of(Database& uploads, const Upload& upload);

/// Tests whether a trip is noted as one of an upload.
bool is_trip_of(Database& uploads, const Upload& upload, const std::string& sha256);
/// Tests whether a trip is noted as one of any upload.
bool is_trip_of_any(Database& uploads, const std::string& sha256);

/// Records the fate of an upload, and removes its log from the spool.
void finish_upload(Database& uploads,
                   const std::filesystem::path& spool,
                   const Upload& upload,
                   UploadState state,
                   const std::string& reason);

/// Puts an upload back into the queue.
void put_back(Database& uploads, const Upload& upload);

/// Upload whose trips are to be forgotten, with their hashes; `std::nullopt` if there is none.
struct Deletion {
    Upload upload;
    std::vector<std::string> trips;
};
std::optional<Deletion> next_deletion(Database& uploads);

/// Forgets an upload whose trips were taken out.
void finish_deletion(Database& uploads, const Upload& upload);

/// Forgets who sent trips that the road database no longer has, and uploads of which none is left.
void drop_missing_trips(Database& uploads,
                        const std::function<bool(const std::string& sha256)>& is_stored);

/// Tells other processes, for as long as the object lives, that this one works out uploads.
class WorkerMark {
public:
    explicit WorkerMark(const std::filesystem::path& spool);
    WorkerMark(const WorkerMark&) = delete;
    WorkerMark& operator=(const WorkerMark&) = delete;
    ~WorkerMark();

    /// Tests whether another process does.
    static bool is_set(const std::filesystem::path& spool);

private:
    int lock_;
};

/// Removes files of the spool that do not wait: of programs that were killed.
void sweep_spool(Database& uploads, const std::filesystem::path& spool);

} // namespace macadam
