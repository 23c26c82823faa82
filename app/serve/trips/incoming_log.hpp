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

/// Tests whether the disk of a folder has so many bytes left, or does not tell.
bool has_free(const std::filesystem::path& folder, std::uint64_t bytes);

/// Body of an upload: written to an unnamed file of the spool and hashed as it comes. Without
/// enqueue() nothing of it remains.
class IncomingLog final : public HttpBody {
public:
    /// \param min_free_bytes  on the disk, whatever others send at the same time
    IncomingLog(const std::filesystem::path& spool, Upload upload, std::uint64_t min_free_bytes);

    /// \throws InputError  if the disk has less, or cannot be written.
    void add(std::string_view bytes) override;

    /// SHA-256 of all bytes; nothing can be added afterwards.
    std::string sha256() { return hash_.hex(); }

    const Upload& upload() const { return upload_; }

    /// Its file, which is made with the first bytes: a disk may take its time for it.
    AtomicFile& file();

private:
    std::filesystem::path spool_;
    std::uint64_t min_free_bytes_;
    std::int64_t looked_at_bytes_ = 0; ///< received when the disk was last looked at
    Upload upload_;                    ///< its `bytes` are those received
    std::optional<AtomicFile> file_;
    Sha256 hash_;
};

} // namespace macadam
