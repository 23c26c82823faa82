#include "storage/store/server/reader/local_copy.hpp"

#include "storage/postgres/server_address.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/store/server/reader/server_mirror.hpp"
#include "storage/store/server/reader/server_reader.hpp"

#include <system_error>
#include <utility>

namespace macadam {
namespace {

namespace fs = std::filesystem;

} // namespace

LocalCopy::LocalCopy(fs::path store,
                     LockWaitPolicy wait_policy,
                     const Progress& progress,
                     Audience audience)
    : store_{std::move(store)},
      wait_policy_{std::move(wait_policy)}, audience_{audience}, file_{store_} {
    if (is_server_address(store_.string())) {
        folder_.emplace(fs::temp_directory_path() / "macadam");
        file_ = folder_->path() / (title_of(store_) + ".gpkg");
        refresh(progress);
    }
}

void LocalCopy::refresh(const Progress& progress) {
    if (!folder_) {
        return;
    }
    ServerConnection server{store_.string()};
    const auto copy =
        refreshed_mirror(server, content_for(server, true, audience_), wait_policy_, progress);
    std::error_code none;
    if (fs::read_symlink(file_, none) != copy) {
        const auto other = folder_->path() / "next";
        fs::create_symlink(copy, other);
        fs::rename(other, file_);
    }
}

std::string title_of(const fs::path& store) {
    return is_server_address(store.string()) ? database_name(store.string())
                                             : store.stem().string();
}

} // namespace macadam
