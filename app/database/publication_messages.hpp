#pragma once

#include "app/cli/console.hpp"
#include "storage/store/privacy/publication.hpp"
#include "storage/store/road_store.hpp"

#include <optional>
#include <string>

namespace macadam {

/// "publication of 2026-11: 12.3 km in 812 segments, at least 200 trips of at least 50 cars; left
/// out: ..."
std::string words_for(const Publication& publication);

/// Says of a crowd's database what its readers get: the latest publication, or that there is none.
void tell_publication(const RoadStore& store, const Console& console);

/// Opens a store for a command that shows its operator more than is published; says so where it
/// does, since what it prints is not to be handed on.
RoadStore open_for_operator(const std::filesystem::path& file, const Console& console);

/// What only the operator of a crowd may ask for. \param what  "single passes"
/// \throws InputError  if the store shows published figures alone.
void expect_operator(const RoadStore& store, std::string_view what);

/// As a JSON object; "null" if nothing was published.
std::string json_of(const std::optional<Publication>& publication);

} // namespace macadam
