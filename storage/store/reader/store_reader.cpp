#include "storage/store/reader/store_reader.hpp"

#include "mapping/network/build_network.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/fusion/store_calibration.hpp"
#include "storage/store/publication/publication_rows.hpp"
#include "storage/store/rows/known_trips.hpp"
#include "storage/store/rows/store_digest.hpp"
#include "storage/store/schema/network_rows.hpp"

#include <utility>

namespace macadam {

StoreReader StoreReader::open(const std::filesystem::path& file,
                              LockWaitPolicy wait_policy,
                              Audience audience) {
    return StoreReader{
        open_connection(file, Database::Access::read, std::move(wait_policy), audience)};
}

const StoreSettings& StoreReader::settings() const {
    return store_->settings;
}

const std::filesystem::path& StoreReader::file() const {
    return store_->database.file();
}

const PrivacyKey* StoreReader::key() const {
    return store_->key ? &*store_->key : nullptr;
}

const std::filesystem::path& StoreReader::key_file() const {
    return store_->key_file;
}

bool StoreReader::shows_published_alone() const {
    return store_->published_alone;
}

std::optional<Publication> StoreReader::latest_publication() const {
    return macadam::latest_publication(store_->database);
}

void StoreReader::expect_in_place() const {
    store_->database.expect_in_place();
}

RoadNetwork StoreReader::roads() const {
    Transaction one_moment{store_->database, Transaction::Kind::read};
    store_->expect_same_network();
    return build_network(read_ways(store_->database), store_->settings.segment_length_m);
}

std::string StoreReader::network_hash() const {
    return store_->network_hash;
}

std::vector<std::string> StoreReader::highways() const {
    auto select = store_->database.prepare("SELECT DISTINCT coalesce(highway, '') AS class FROM way"
                                           " ORDER BY class LIMIT 100");
    std::vector<std::string> classes;
    while (select.step()) {
        classes.push_back(select.text(0));
    }
    return classes;
}

bool StoreReader::contains_trip(const std::string& sha256) const {
    return row_of_trip(store_->database, sha256).has_value();
}

bool StoreReader::is_trip_of(const std::string& sha256, const std::string& vehicle_id) const {
    auto select = store_->database.prepare(
        "SELECT 1 FROM trip CROSS JOIN vehicle ON vehicle.id = trip.vehicle"
        " WHERE sha256 = ? AND pseudonym = ?");
    return is_operator() && select.bind(sha256, store_->pseudonym(vehicle_id)).step();
}

std::optional<TripSettings> StoreReader::settings_of_trip(const std::string& sha256) const {
    auto select = store_->database.prepare(
        "SELECT method, vehicle_model FROM trip WHERE sha256 = ? AND reference_ppm IS NULL");
    return select.bind(sha256).step() ? std::optional{TripSettings{select.text(0), select.text(1)}}
                                      : std::nullopt;
}

bool StoreReader::has_forgotten(const std::string& sha256) const {
    return is_forgotten(store_->database, sha256);
}

CalibrationReport StoreReader::estimate_calibration(const Progress& progress) const {
    Transaction one_moment{store_->database, Transaction::Kind::read};
    return find_calibration(
        store_->database, store_->segments_per_chunk(), CalibrationBasis::all, progress);
}

std::string StoreReader::digest() const {
    Transaction one_moment{store_->database, Transaction::Kind::read};
    return digest_of(store_->database, {});
}

} // namespace macadam
