#pragma once

#include "storage/atomic/atomic_file.hpp"
#include "storage/uploads/access_token.hpp"
#include "storage/uploads/upload_queue.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Tokens and uploads of a database, by a connection that one thread uses at a time: beside its
/// file (storage/uploads), or on its server (storage/jobs).
///
/// \throws InputError  from every call that fails.
class UploadStore {
public:
    UploadStore() = default;
    UploadStore(const UploadStore&) = delete;
    UploadStore& operator=(const UploadStore&) = delete;
    virtual ~UploadStore() = default;

    /// \name For the thread of the network, too: they never wait for another machine
    /// @{
    virtual std::optional<AccessToken> find_token(std::string_view text, std::int64_t now_ms) = 0;
    virtual std::size_t count_waiting() = 0;
    /// Tells why no upload can be taken now; "" = it can.
    virtual std::string refusal() = 0;
    /// @}

    /// \throws OtherScope
    virtual std::optional<std::string> take_invitation(std::string_view text,
                                                       std::int64_t now_ms) = 0;
    virtual std::optional<Upload> find_upload(const std::string& sha256) = 0;
    virtual std::vector<Upload> latest_uploads(const std::string& owner, std::size_t limit) = 0;

    /// Keeps a log and adds it to the queue: when this returns true, no kill loses it.
    /// \returns false if it is known; the file then vanishes.
    virtual bool enqueue(AtomicFile& file, const Upload& upload) = 0;

    /// \returns true if nothing is left of the upload; false if a worker will delete its trips.
    virtual bool delete_upload(const std::string& sha256) = 0;
};

/// Place at which a database has its tokens and uploads. Thread-safe.
class UploadPlace {
public:
    UploadPlace() = default;
    UploadPlace(const UploadPlace&) = delete;
    UploadPlace& operator=(const UploadPlace&) = delete;
    virtual ~UploadPlace() = default;

    /// Opens it; null while nobody has made a token.
    /// \throws InputError
    virtual std::unique_ptr<UploadStore> open() = 0;

    /// Folder for logs while they come.
    virtual std::filesystem::path spool() const = 0;
};

/// Place beside a database that is a file.
std::unique_ptr<UploadPlace> uploads_beside(const std::filesystem::path& store);

} // namespace macadam
