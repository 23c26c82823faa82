#include "storage/uploads/kept_logs.hpp"

#include "storage/uploads/sealed_log.hpp"
#include "storage/uploads/upload_database.hpp"

#include <algorithm>
#include <system_error>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view sealed_suffix = ".sealed";
constexpr std::size_t hash_digits = 64;

fs::path kept_logs_of(const fs::path& store) {
    return uploads_folder_of(store) / "kept";
}

fs::path file_of(const fs::path& store, const Upload& upload) {
    return kept_logs_of(store) / (upload.sha256 + upload.suffix + std::string{sealed_suffix});
}

bool are_stored(Database& uploads,
                const Upload& upload,
                const std::function<bool(const std::string& sha256)>& is_stored) {
    const auto trips = trips_of(uploads, upload);
    return !trips.empty() && std::ranges::all_of(trips, is_stored);
}

} // namespace

void keep_log(const fs::path& store, const Upload& upload, std::string_view public_key) {
    const auto folder = kept_logs_of(store);
    std::error_code error;
    fs::create_directory(folder, error); // within a folder of the owner alone
    seal_log(upload.file_in(spool_of(store)), file_of(store, upload), public_key);
}

std::vector<KeptLog> kept_logs(const fs::path& store) {
    std::vector<KeptLog> logs;
    std::error_code gone;
    for (fs::directory_iterator file{kept_logs_of(store), gone}, end; !gone && file != end;
         file.increment(gone)) {
        auto name = file->path().filename().string();
        if (name.size() > hash_digits && name.ends_with(sealed_suffix)) {
            name.resize(name.size() - sealed_suffix.size());
            logs.push_back({.file = file->path(), .name = std::move(name)});
        }
    }
    std::ranges::sort(logs, {}, &KeptLog::name);
    return logs;
}

void erase_kept_log(const fs::path& store, const Upload& upload) {
    std::error_code gone;
    fs::remove(file_of(store, upload), gone);
}

void erase_old_logs(Database& uploads,
                    const fs::path& store,
                    std::int64_t received_before_ms,
                    const std::function<bool(const std::string& sha256)>& is_stored) {
    for (const auto& log : kept_logs(store)) {
        const auto upload = find_upload(uploads, log.name.substr(0, hash_digits));
        // One that waits was begun before a kill, and is sealed again.
        const bool stays = upload && !upload->deleting &&
                           upload->received_ms > received_before_ms &&
                           (is_waiting(upload->state) || are_stored(uploads, *upload, is_stored));
        if (!stays) {
            std::error_code gone;
            fs::remove(log.file, gone);
        }
    }
}

} // namespace macadam
