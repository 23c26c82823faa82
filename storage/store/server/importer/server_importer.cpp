#include "storage/store/server/importer/server_importer.hpp"

#include "estimator/common/error.hpp"
#include "storage/jobs/worker_register.hpp"
#include "storage/store/rows/known_trips.hpp"
#include "storage/store/server/cells/cell_drives.hpp"
#include "storage/store/server/importer/network_image.hpp"
#include "storage/store/server/importer/old_server_changes.hpp"
#include "storage/store/server/importer/server_fusion.hpp"
#include "storage/store/server/importer/trip_rows.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_schema.hpp"
#include "storage/store/server/user_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace macadam {
namespace {

class ServerImporter final : public ImportTarget {
public:
    ServerImporter(std::unique_ptr<ServerConnection> server,
                   ServerSettings settings,
                   std::shared_ptr<StoreConnection> image,
                   std::optional<int> results_version)
        : server_{std::move(server)}, settings_{std::move(settings)}, image_{std::move(image)},
          results_version_{results_version}, rows_{*image_}, key_{read_own_key()},
          fusion_{*server_, *image_, rows_, [this] { expect_same(); }} {}

    bool contains_trip(const std::string& sha256) override {
        return !server_->rows("SELECT 1 FROM macadam.trip WHERE sha256 = $1", {sha256}).empty() &&
               is_settled(sha256);
    }

    bool is_trip_of(const std::string& sha256, const std::string& vehicle_id) override {
        return key_ && !server_
                            ->rows("SELECT 1 FROM macadam.trip JOIN macadam.vehicle"
                                   " ON vehicle.id = trip.vehicle"
                                   " WHERE sha256 = $1 AND pseudonym = $2",
                                   {sha256, key_->pseudonym(vehicle_id)})
                            .empty();
    }

    std::optional<TripSettings> settings_of_trip(const std::string& sha256) override {
        const auto found = server_->rows("SELECT method, vehicle_model FROM macadam.trip"
                                         " WHERE sha256 = $1 AND reference_ppm IS NULL",
                                         {sha256});
        if (found.empty()) {
            return std::nullopt;
        }
        return TripSettings{found[0][0].value_or(""), found[0][1].value_or("")};
    }

    bool has_forgotten(const std::string& sha256) override {
        return !server_
                    ->rows("SELECT 1 FROM macadam.forgotten WHERE mark = $1",
                           {forgotten_mark(sha256)})
                    .empty();
    }

    bool make_missing_key() override {
        if (!key_ && !(key_ = read_own_key())) {
            refuse_missing_key(server_->address(), key_file());
        }
        return false;
    }

    const PrivacyKey* key() const override { return key_ ? &*key_ : nullptr; }

    std::filesystem::path key_file() const override { return server_key_file(settings_.key_id); }

    std::vector<bool> add_trips(std::span<const NewTrip> trips) override {
        if (std::ranges::any_of(trips, [](const auto& t) { return !t.trip->vehicle_id.empty(); })) {
            make_missing_key();
        }
        const TripTarget target{
            *server_, cell_drives_, settings_, *image_, rows_, key(), results_version_};
        return write_trips(target, trips);
    }

    BegunImport begin_import(const std::string& name, std::size_t trips_asked) override {
        remove_unfinished(*server_);
        const auto number = number_of_import(name);
        take_import_lock(*server_, number);
        BegunImport begun;
        begun.same_runs = is_other_importing(*server_, number);
        begun.other_runs = is_other_importing(*server_, {});
        begun.earlier = open_import(name);
        server_->rows("INSERT INTO macadam.import_note (name, asked, trips_before)"
                      " SELECT $1, $2::bigint, count(*) FROM macadam.trip"
                      " ON CONFLICT (name) DO NOTHING",
                      {name, std::to_string(trips_asked)});
        return begun;
    }

    void end_import(const std::string& name) override {
        server_->rows("DELETE FROM macadam.import_note WHERE name = $1", {name});
        release_import_lock(*server_, number_of_import(name));
    }

    std::size_t refresh(const Progress& progress, FusionRecord& record, BusyChunks busy) override {
        const auto fused = fusion_.fuse_marked(progress, record, busy);
        remove_old_changes(*server_);
        return fused;
    }

    std::size_t waiting() override {
        std::size_t segments = 0;
        for (const auto chunk :
             server_->numbers("SELECT DISTINCT chunk FROM macadam.chunk_dirty")) {
            const auto& place = rows_.place_of(chunk);
            segments += static_cast<std::size_t>(place.last - place.first + 1);
        }
        return segments;
    }

    AlignmentSummary alignment() override {
        // The median is that of the chunks' medians, weighted by their drives that were found.
        const auto sums = server_->numbers(
            "WITH summed AS (SELECT middle_lag_cm, sum(found) OVER (ORDER BY middle_lag_cm"
            " ROWS UNBOUNDED PRECEDING) AS until FROM macadam.chunk_state),"
            " whole AS (SELECT coalesce(sum(drives), 0) AS drives, coalesce(sum(found), 0) AS"
            " found, coalesce(sum(beyond_reach), 0) AS beyond_reach, coalesce(sum(moved_far), 0)"
            " AS moved_far FROM macadam.chunk_state)"
            " SELECT drives, found, beyond_reach, moved_far, coalesce((SELECT min(middle_lag_cm)"
            " FROM summed WHERE until > div(found, 2)), 0) FROM whole");
        return {.drives = sums.at(0),
                .found = sums.at(1),
                .beyond_reach = sums.at(2),
                .moved_far = sums.at(3),
                .middle_lag_cm = static_cast<std::int32_t>(sums.at(4))};
    }

private:
    std::optional<PrivacyKey> read_own_key() const {
        auto key = read_key(key_file());
        if (key && key->id() != settings_.key_id) {
            throw InputError{fmt::format("{}: is not the key of {}; restore its own key",
                                         key_file().string(),
                                         server_->address())};
        }
        return key;
    }

    /// Begins the work of a transaction, beside other importers but not beside who changes rules or
    /// roads.
    void expect_same() {
        const std::array begin{sharing_database(), asking_for_settings()};
        expect_same_settings(
            *server_, settings_, settings_in(server_->rows_of_all(begin).at(1)), results_version_);
    }

    /// Waits until a trip that the server has is on its standby too: whoever stored it may still
    /// wait for that. A commit that writes something waits.
    bool is_settled(const std::string& sha256) {
        ServerTransaction all{*server_};
        const bool is_there = !server_
                                   ->rows("UPDATE macadam.trip SET trip_id = trip_id"
                                          " WHERE sha256 = $1 RETURNING id",
                                          {sha256})
                                   .empty();
        all.commit();
        return is_there;
    }

    std::optional<OpenImport> open_import(const std::string& name) {
        const auto found = server_->numbers("SELECT asked, greatest(0, (SELECT count(*) FROM"
                                            " macadam.trip) - trips_before)"
                                            " FROM macadam.import_note WHERE name = $1",
                                            {name});
        if (found.empty()) {
            return std::nullopt;
        }
        return OpenImport{static_cast<std::size_t>(found[0]), static_cast<std::size_t>(found[1])};
    }

    std::unique_ptr<ServerConnection> server_;
    CellDrives cell_drives_{*server_};
    ServerSettings settings_;
    std::shared_ptr<StoreConnection> image_;
    std::optional<int> results_version_;
    ImageRows rows_;
    std::optional<PrivacyKey> key_;
    ServerFusion fusion_;
};

} // namespace

ServerImport open_server_import(const std::string& address,
                                const Progress& progress,
                                std::optional<int> results_version) {
    auto server = std::make_unique<ServerConnection>(address);
    // All that an import looks up has an index, and tables grow faster than what the planner knows
    // of them.
    server->run("SET enable_seqscan = off; SET jit = off");
    ServerTransaction one_moment{*server, true};
    expect_server_schema(*server);
    auto settings = read_server_settings(*server);
    if (settings.key_id.empty()) { // which readers of a crowd do not see
        throw InputError{fmt::format("{}: the role may not import; its owner grants "
                                     "macadam_importer (docs/reference/postgresql.md)",
                                     address)};
    }
    if (results_version) {
        expect_results_version(*server, *results_version);
    }
    auto image = open_network_image(*server, settings, progress);
    one_moment.commit();
    ServerImport open;
    open.image = image;
    open.by_superuser = server->is_superuser();
    open.trips = std::make_shared<ServerImporter>(
        std::move(server), std::move(settings), std::move(image), results_version);
    return open;
}

} // namespace macadam
