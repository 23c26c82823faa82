#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/privacy/privacy_key.hpp"

#include <cstddef>
#include <cstdint>

namespace macadam {

/// By what a publication is made.
struct PublicationWork {
    const RoadNetwork* roads;
    const PrivacyKey* key;
    const ClassTable* classes;
    std::int64_t segments_per_chunk;
};

/// Adds to tables published_state and published_figure what passes that no publication tells of
/// yet may tell (mapping/privacy/release_batches.hpp); a segment without a batch of them keeps what
/// was published last. Within the caller's transaction.
///
/// Passes in the first and the last block of a drive are told of nowhere.
///
/// \returns  how many segments tell something new
std::size_t
publish_pending(Database& database, const PublicationWork& work, const Progress& progress);

} // namespace macadam
