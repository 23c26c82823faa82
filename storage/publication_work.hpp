#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/iri_class.hpp"
#include "mapping/road_network.hpp"
#include "storage/privacy_key.hpp"
#include "storage/sqlite.hpp"

#include <cstddef>
#include <cstdint>

namespace macadam {

/// By what a publication is made.
struct PublicationWork {
    const RoadNetwork* roads;
    const PrivacyKey* key;
    const ClassTable* classes;
    std::int64_t segments_in_strip;
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
