#pragma once

#include "mapping/network/road_network.hpp"
#include "storage/store/road_store.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace macadam {

// A network as a file that is mapped into memory and read in place (docs/reference/road-maps.md).
// It is a cache: whatever it holds can be made again from the map or from the store.

/// \param source  64 hex digits that say what the network was made of
/// \throws InputError  if the file cannot be written; then nothing is left.
void write_network_file(const RoadNetwork& roads,
                        std::string_view source,
                        const std::filesystem::path& file);

struct NetworkFile {
    RoadNetwork roads; ///< keeps the file mapped
    std::string source;
};

/// \throws InputError  if the file is missing, no network file, one of another version, or damaged.
NetworkFile open_network_file(const std::filesystem::path& file);

/// Whether the file begins as write_network_file begins it. False for a file that is not there.
bool is_network_file(const std::filesystem::path& file);

/// Where a store's network lies: beside it, as STORE-network.
std::filesystem::path network_file_of(const std::filesystem::path& store);

/// The network of a store. Taken from the file beside it, if that was made of the store's own ways;
/// else built from them, and written there if the folder can be written.
///
/// \param warn  is told if there is a file that is not to be used
RoadNetwork load_or_build_network(const RoadStore& store,
                                  const std::function<void(const std::string&)>& warn = {});

/// Writes the network of a store beside it. \returns false if that cannot be done: the store serves
/// without it, a little slower.
bool cache_network(const RoadStore& store, const RoadNetwork& roads);

} // namespace macadam
