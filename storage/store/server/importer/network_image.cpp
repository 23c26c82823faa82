#include "storage/store/server/importer/network_image.hpp"

#include "estimator/common/error.hpp"
#include "storage/jobs/worker_register.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/server_schema.hpp"
#include "storage/store/server/user_files.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

namespace macadam {

namespace {

constexpr const char* settings_rows = "SELECT key, value FROM macadam.meta"
                                      " WHERE key IN ('network_rows', 'privacy', 'key_id')";

} // namespace

ServerStatement asking_for_settings() {
    return ServerStatement{fmt::format("{} UNION ALL {}", settings_rows, results_version_row)};
}

ServerSettings settings_in(const std::vector<ServerRow>& rows) {
    ServerSettings settings;
    for (const auto& row : rows) {
        const auto value = row[1].value_or("");
        (row[0] == "network_rows"      ? settings.network_rows
         : row[0] == "privacy"         ? settings.privacy
         : row[0] == "results_version" ? settings.results_version
                                       : settings.key_id) = value;
    }
    return settings;
}

ServerSettings read_server_settings(ServerConnection& server) {
    return settings_in(server.rows(settings_rows));
}

void expect_same_settings(const ServerConnection& server,
                          const ServerSettings& before,
                          const ServerSettings& now,
                          std::optional<int> results_version) {
    if (results_version) {
        expect_results_version(server, now.results_version, *results_version);
    }
    if (now.network_rows != before.network_rows || now.privacy != before.privacy ||
        now.key_id != before.key_id) {
        throw InputError{fmt::format("{}: its roads or its key were changed in the meantime; "
                                     "nothing was written, run the command again",
                                     server.address())};
    }
}

std::shared_ptr<StoreConnection> open_network_image(ServerConnection& server,
                                                    const ServerSettings& settings,
                                                    const Progress& progress) {
    namespace fs = std::filesystem;
    const auto file = network_image_file(server.address(), settings.network_rows);
    std::error_code error;
    if (!fs::exists(file, error)) {
        fs::create_directories(file.parent_path(), error);
        fs::permissions(
            file.parent_path(), fs::perms::owner_all, error); // traced roads are private
        try {
            copy_network_from_server(server, file, progress);
        } catch (const InputError&) {
            if (!fs::exists(file, error)) { // not even by another process, meanwhile
                throw;
            }
        }
    }
    return open_connection(file, Database::Access::read, {}, Audience::anyone);
}

ImageRows::ImageRows(StoreConnection& image)
    : image_{&image}, segments_{image.database, image.segments_per_chunk()},
      select_chunk_{image.database.prepare(
          "SELECT max(fid), way_id FROM segment WHERE fid >= ?1 AND fid < ?1 + ?2"
          " AND strip = ?1")},
      select_points_{image.database.prepare("SELECT points FROM way WHERE way_id = ?")} {}

const ChunkPlace& ImageRows::place_of(std::int64_t chunk) {
    constexpr std::size_t most_known = 100'000; // 5 MB
    if (const auto known = places_.find(chunk); known != places_.end()) {
        return known->second;
    }
    select_chunk_.bind(chunk, image_->segments_per_chunk()).step();
    if (select_chunk_.is_null(0)) {
        select_chunk_.reset();
        throw InputError{fmt::format("{}: has no strip {}, expected those of the server; remove "
                                     "this file, so that it is fetched again",
                                     image_->database.file().string(),
                                     chunk)};
    }
    ChunkPlace place{0, chunk, select_chunk_.integer(0)};
    select_points_.bind(select_chunk_.integer(1)).step();
    place.cell = cell_of_way(select_points_.blob(0));
    select_points_.reset();
    select_chunk_.reset();
    if (places_.size() >= most_known) {
        places_.clear();
    }
    return places_.emplace(chunk, place).first->second;
}

} // namespace macadam
