#pragma once

#include "app/cli/console.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/store/records/publication.hpp"
#include "storage/store/server/reader/server_reader.hpp"

#include <optional>
#include <string>

namespace macadam {

/// Describes a publication: "publication of 2026-11: 12.3 km in 812 segments, from at least 200
/// trips of 50 cars; left out: ..."
std::string words_for(const Publication& publication);

/// Tells readers of a crowd database the latest publication, or that there is none.
void tell_publication(const StoreReader& store, const Console& console);

/// Tests whether a map or report can show the events of a selection. Warns if not: a crowd database
/// publishes them without months, so that no period selects among them.
bool can_show_events(const StoreReader& store, const SegmentFilter& filter, const Console& console);

/// Opens a database for a command that shows its operator more than is published. Says so in that
/// case, since the output must not be passed on.
StoreReader open_for_operator(const std::filesystem::path& file,
                              const Console& console,
                              const ServerNeed& need = {});

/// Restricts a request to the operator of a crowd database.
/// \param what         subject of the message: "single passes"
/// \throws InputError  if the database shows published values only.
void expect_operator(const StoreReader& store, std::string_view what);

/// Formats a publication as a JSON object; "null" if there is none.
std::string json_of(const std::optional<Publication>& publication);

} // namespace macadam
