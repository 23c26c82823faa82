#pragma once

#include "app/cli/console.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <string>

namespace macadam {

/// Says why no segment has a value, and what to do: "no trips yet: 'macadam import roads.gpkg ...'
/// adds them"; "" if some have one.
std::string empty_map_text(const StoreReader& store);

/// Warns in these words if no segment has a value.
void warn_of_empty_map(const StoreReader& store, const Console& console);

} // namespace macadam
