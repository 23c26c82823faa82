#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/network/road_network.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/records/publication.hpp"

#include <cstddef>
#include <cstdint>

namespace macadam {

/// Input of a publication.
struct PublicationWork {
    const RoadNetwork* roads;
    const PrivacyKey* key;
    const ClassTable* classes;
    std::int64_t segments_per_chunk;
    const PublishedPart* part = nullptr; ///< null: the database is whole
};

/// Stages the publication of pending passes in the tables of StagedPublication, in batches that
/// satisfy the release rule (mapping/privacy/release_batches.hpp); a segment without such a batch
/// keeps its last published values. Reads the database as the caller's transaction sees it.
///
/// Passes in the first and last block of a drive are never published.
///
/// \returns  the number of segments with new values
/// \throws InputError  if a stop is requested.
std::size_t
stage_pending(Database& database, const PublicationWork& work, const Progress& progress);

} // namespace macadam
