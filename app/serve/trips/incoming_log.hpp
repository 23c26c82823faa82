#pragma once

#include "app/http/http_message.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/files/sha256.hpp"
#include "storage/uploads/upload_queue.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// Returns the suffix by which `import` knows the format of an upload, ".csv.gz": that of the file
/// name in Content-Disposition if it is one of trip logs, else the one of the Content-Type.
/// `std::nullopt` if neither says one that is read. Nothing else of the name is used.
std::optional<std::string> suffix_of_upload(const HttpRequest& request);

/// Body of an upload: written to an unnamed file of the spool and hashed as it comes. Without
/// enqueue() nothing of it remains.
class IncomingLog final : public HttpBody {
public:
    /// \throws InputError  if the file cannot be made.
    IncomingLog(const std::filesystem::path& spool, Upload upload);

    void add(std::string_view bytes) override;

    /// SHA-256 of all bytes; nothing can be added afterwards.
    std::string sha256() { return hash_.hex(); }

    const Upload& upload() const { return upload_; }
    AtomicFile& file() { return file_; }

private:
    Upload upload_; ///< its `bytes` are those received
    AtomicFile file_;
    Sha256 hash_;
};

} // namespace macadam
