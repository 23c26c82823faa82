#pragma once

#include "mapping/network/road_network.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace macadam {

// Network as a file that is memory-mapped and read in place (docs/reference/road-maps.md). It is a
// cache: it can always be rebuilt from the map or from the database.

/// Writes a network file.
///
/// \param source  64 hex digits that identify the origin of the network.
/// \throws InputError  if the file cannot be written; then no file is left.
void write_network_file(const RoadNetwork& roads,
                        std::string_view source,
                        const std::filesystem::path& file);

struct NetworkFile {
    RoadNetwork roads; ///< keeps the file mapped
    std::string source;
};

/// Opens a network file.
///
/// \throws InputError  if the file is missing, not a network file, of another version, or damaged.
NetworkFile open_network_file(const std::filesystem::path& file);

/// Tests whether a file begins like a network file; false if it does not exist.
bool is_network_file(const std::filesystem::path& file);

/// Network file of a database, beside it: DATABASE-network.
std::filesystem::path network_file_of(const std::filesystem::path& store);

/// Loads the network of a database from the file beside it if that was made of the same ways;
/// otherwise builds it from the database, and writes the file if the folder is writable.
///
/// \param warn  called if the existing file cannot be used.
RoadNetwork load_or_build_network(const StoreReader& store,
                                  const std::function<void(const std::string&)>& warn = {});

/// Writes the network of a database beside it. \returns false if that fails; the database works
/// without it, slightly slower.
bool cache_network(const StoreReader& store, const RoadNetwork& roads);

} // namespace macadam
