#include "estimator/common/error.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/fusion/dirty_fusion.hpp"
#include "storage/store/maintenance/network_move.hpp"
#include "storage/store/maintenance/store_maintenance.hpp"
#include "storage/store/rows/audit.hpp"
#include "storage/store/schema/network_rows.hpp"
#include "storage/store/schema/store_schema.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

// Less is another area, or an overlap at the border of a neighbouring one.
constexpr double min_common_share = 0.05;

void expect_common_roads(const ChangeSummary& roads,
                         const std::filesystem::path& store,
                         const std::string& network) {
    const double common_m = roads.kept.length_m + roads.split.length_m + roads.merged.length_m +
                            roads.renamed.length_m + roads.moved.length_m;
    const double share = common_m / (common_m + roads.lost.length_m);
    if (!(share >= min_common_share)) {
        throw InputError{fmt::format("{}: only {:.1f} % of its roads are in '{}', expected a "
                                     "map of the same area; the database is unchanged",
                                     store.string(),
                                     100 * share,
                                     network)};
    }
}

std::string words_for_audit(const NetworkUpdate& update, const std::string& network) {
    constexpr double m_per_km = 1000;
    return fmt::format("network {}: {:.1f} km of road lost, {:.1f} km new; {} passes carried, {} "
                       "lost",
                       network,
                       update.roads.lost.length_m / m_per_km,
                       update.roads.added.length_m / m_per_km,
                       update.passes_carried,
                       update.passes_lost);
}

} // namespace

NetworkUpdate StoreMaintenance::update_network(const RoadNetwork& before,
                                               const RoadNetwork& after,
                                               const NetworkChange& change,
                                               const NetworkSource& source,
                                               const Progress& progress) {
    auto& database = store_->database;
    const SegmentCorrespondences correspondences{before, after, change};
    NetworkUpdate update{.roads = summary_of(change, correspondences)};
    expect_common_roads(update.roads, database.file(), source.name);
    const auto hash = hash_of_ways(after);

    Transaction all{database, Transaction::Kind::write};
    store_->expect_same_network();
    update.passes_kept = static_cast<std::size_t>(database.number("SELECT count(*) FROM pass"));
    if (hash == store_->network_hash) {
        update.generation = read_generation(database);
        return update;
    }
    const auto moved = move_to_network(database, correspondences, progress);
    update.passes_carried = moved.carried;
    update.passes_lost = moved.lost;
    update.passes_now = moved.now;
    update.lost_sections = moved.lost_sections;
    update.passes_kept -= moved.carried + moved.lost;
    update.changed = true;
    const auto segments = count_segments(after);
    update_network_meta(
        database, {source.name, source.attribution, hash, segments.segments, segments.length_m});
    update_extent(database, extent_of(after));
    update.generation = begin_generation(database);
    const auto audit = add_audit(database, "network", words_for_audit(update, source.name));
    fuse_dirty_at_once(
        database, {store_->segments_per_chunk(), &store_->classes(), audit}, progress);
    all.commit();
    store_->network_hash = hash;
    store_->settings = read_settings(database);
    store_->written(progress);
    return update;
}

} // namespace macadam
