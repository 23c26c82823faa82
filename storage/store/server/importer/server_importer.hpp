#pragma once

#include "estimator/common/progress.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/importer/import_target.hpp"

#include <memory>
#include <optional>
#include <string>

namespace macadam {

/// Database on a server, open for imports.
struct ServerImport {
    std::shared_ptr<StoreConnection> image; ///< its roads and settings, without trips
    std::shared_ptr<ImportTarget> trips;
    bool by_superuser = false; ///< of the server
};

/// Opens a database on a server for imports. Any number of workers may import and fuse at once: the
/// result is that of any other order, and of a file.
///
/// Roads come from a copy that this user keeps (network_image_file()); the key, which the server
/// never sees, from server_key_file(), and make_missing_key() throws if it is not there.
///
/// A trip counts as stored, or as known, only once the server has committed, and where it waits
/// for a standby, that has it. If the answer is lost, the call throws: the trip is in doubt, and
/// giving it again settles it.
///
/// \param progress  of fetching the roads
/// \param results_version  of the program (app/pipeline/results_version.hpp): nothing is written
///                         once workers have another one; `std::nullopt` fits all.
/// \throws InputError  if the server cannot be reached, or has no road database.
/// \throws OtherResults  if workers have another version of results.
ServerImport open_server_import(const std::string& address,
                                const Progress& progress = {},
                                std::optional<int> results_version = {});

} // namespace macadam
