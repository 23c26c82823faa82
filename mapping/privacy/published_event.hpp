#pragma once

#include "mapping/events/event_fusion.hpp"
#include "mapping/privacy/release_batches.hpp"

#include <optional>

namespace macadam {

/// Coarsens an event for publication: dates to months, counts by published_count(), its place to
/// metres, its size to 5 mm. `std::nullopt` if fewer cars report it than the rule asks for.
///
/// \param event  with its cars, fused from passes that are published
std::optional<FusedEvent> published(FusedEvent event, const ReleaseRule& rule);

} // namespace macadam
