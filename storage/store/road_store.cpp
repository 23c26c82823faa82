#include "storage/store/road_store.hpp"

#include "estimator/common/error.hpp"
#include "mapping/network/build_network.hpp"
#include "storage/atomic/atomic_file_set.hpp"
#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/sqlite/sqlite_header_check.hpp"
#include "storage/store/fusion/dirty_fusion.hpp"
#include "storage/store/privacy/trip_names.hpp"
#include "storage/store/rejection_reasons.hpp"
#include "storage/store/road_store_impl.hpp"
#include "storage/store/rows/pass_writer.hpp"
#include "storage/store/rows/trip_tombstones.hpp"
#include "storage/store/schema/network_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace macadam {
namespace {

void refuse_existing(const std::filesystem::path& file) {
    if (std::filesystem::exists(std::filesystem::symlink_status(file))) {
        throw InputError{
            fmt::format("{}: already exists, expected the name of a new file", file.string())};
    }
}

std::int64_t row_of_vehicle(Database& database, const std::string& pseudonym) {
    database.prepare("INSERT OR IGNORE INTO vehicle (pseudonym) VALUES (?)").run(pseudonym);
    auto select = database.prepare("SELECT id FROM vehicle WHERE pseudonym = ?");
    select.bind(pseudonym).step();
    return select.integer(0);
}

/// \param car  pseudonym; unused for a survey.
std::int64_t write_trip(Database& database, const TripRecord& trip, const std::string& car) {
    std::optional<std::int64_t> vehicle, reference_ppm, reference_row_mm;
    if (trip.reference) {
        reference_ppm = trip.reference->relative_sd_ppm;
        reference_row_mm = trip.reference->row_mm;
    } else {
        vehicle = row_of_vehicle(database, car);
    }
    database
        .prepare("INSERT INTO trip (sha256, trip_id, vehicle, file_name, t0_utc_ms, vehicle_model,"
                 " method, distance_mm, matched_mm, rows_read, rows_used, reference_ppm,"
                 " reference_row_mm) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .run(trip.sha256,
             without_vehicle_id(trip.trip_id, trip.vehicle_id),
             vehicle,
             without_vehicle_id(trip.file_name, trip.vehicle_id),
             trip.t0_utc_ms,
             trip.vehicle_model,
             trip.method,
             trip.distance_mm,
             trip.matched_mm,
             static_cast<std::int64_t>(trip.rows_read),
             static_cast<std::int64_t>(trip.rows_used),
             reference_ppm,
             reference_row_mm);
    return database.number("SELECT last_insert_rowid()");
}

bool has_trip(Database& database, const std::string& sha256) {
    return database.prepare("SELECT 1 FROM trip WHERE sha256 = ?").bind(sha256).step();
}

} // namespace

RoadStore::RoadStore(std::unique_ptr<Impl> impl) : impl_{std::move(impl)} {}
RoadStore::RoadStore(RoadStore&&) noexcept = default;
RoadStore& RoadStore::operator=(RoadStore&&) noexcept = default;
RoadStore::~RoadStore() = default;

RoadStore RoadStore::create(const std::filesystem::path& file,
                            const RoadNetwork& roads,
                            const StoreSettings& settings,
                            const Progress& progress) {
    refuse_existing(file);
    const auto key_file = key_file_of(file);
    const auto old_key = read_key(key_file);
    const auto key = old_key.value_or(PrivacyKey::make());
    AtomicFileSet whole{file};
    Database database{whole.main_file(), Database::Access::create, file};
    add_geometry_functions(database);
    write_store(database, roads, settings, key.id(), progress);
    database.close();
    remove_leftovers_of(file);
    if (!old_key) {
        write_key(key_file, key);
    }
    try {
        whole.commit_new();
    } catch (...) {
        std::error_code ignored;
        if (!old_key && !std::filesystem::exists(file, ignored)) {
            std::filesystem::remove(key_file, ignored);
        }
        throw;
    }
    return open(file, Access::write);
}

RoadStore RoadStore::open(const std::filesystem::path& file,
                          Access access,
                          LockWaitPolicy wait_policy,
                          Reader reader) {
    expect_store_file(file);
    auto impl = std::make_unique<Impl>(file,
                                       access == Access::read ? Database::Access::read
                                                              : Database::Access::write,
                                       std::move(wait_policy));
    const bool sees_all = reader == Reader::operator_ && impl->key;
    if (impl->settings.privacy == PrivacyProfile::crowd && access == Access::read && !sees_all) {
        impl->show_published_alone();
    }
    return RoadStore{std::move(impl)};
}

const StoreSettings& RoadStore::settings() const {
    return impl_->settings;
}

const std::filesystem::path& RoadStore::file() const {
    return impl_->database.file();
}

void RoadStore::expect_in_place() const {
    impl_->database.expect_in_place();
}

std::string RoadStore::network_hash() const {
    return impl_->network_hash;
}

const PrivacyKey* RoadStore::key() const {
    return impl_->key ? &*impl_->key : nullptr;
}

bool RoadStore::make_missing_key() {
    return impl_->make_missing_key();
}

RoadNetwork RoadStore::roads() const {
    Transaction one_moment{impl_->database, Transaction::Kind::read};
    impl_->expect_same_network();
    return build_network(read_ways(impl_->database), impl_->settings.segment_length_m);
}

bool RoadStore::contains_trip(const std::string& sha256) const {
    return has_trip(impl_->database, sha256);
}

bool RoadStore::add_trip(const TripRecord& trip,
                         std::span<const Pass> passes,
                         std::span<const RoughnessTrace> traces,
                         const std::optional<std::span<const PassEvent>>& events) {
    const NewTrip one{&trip, passes, traces, false, events};
    return add_trips({&one, 1}).front();
}

std::vector<bool> RoadStore::add_trips(std::span<const NewTrip> trips) {
    auto& database = impl_->database;
    if (std::ranges::any_of(trips, [](const auto& t) { return !t.trip->vehicle_id.empty(); })) {
        impl_->make_missing_key();
    }
    const ForeignKeysOff keys_are_looked_up{database};
    Transaction all{database, Transaction::Kind::write};
    impl_->expect_same_network();
    PassWriter writer{
        database, segments_per_chunk(impl_->settings.segment_length_m), Destination::kept};
    std::vector<bool> added;
    for (const auto& [trip, passes, traces, readmit, events] : trips) {
        if (readmit) {
            unmark_forgotten(database, trip->sha256);
        }
        added.push_back(!has_trip(database, trip->sha256) && !is_forgotten(database, trip->sha256));
        if (added.back()) {
            const auto row = write_trip(database, *trip, impl_->pseudonym(trip->vehicle_id));
            write_row_reasons(database, row, trip->row_reasons);
            writer.write(row, passes, traces, events.value_or(std::span<const PassEvent>{}));
            if (events) {
                database.prepare("INSERT INTO event_search VALUES (?)").run(row);
            }
        }
    }
    writer.flush();
    all.commit();
    return added;
}

std::size_t RoadStore::refresh(const Progress& progress) {
    return fuse_dirty(impl_->database,
                      segments_per_chunk(impl_->settings.segment_length_m),
                      impl_->classes(),
                      progress);
}

} // namespace macadam
