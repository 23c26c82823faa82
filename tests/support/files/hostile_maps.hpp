#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace macadam::testing {

/// What hostile maps want to be led to.
struct Baits {
    std::filesystem::path file; ///< outside of the folder of the maps, of lines of text
    std::string url;            ///< of a port of this machine
};

/// Maps that lead their reader to other files, servers and libraries, each by another way, in a
/// folder of their own. Some of them are whole maps with something hostile beside or inside.
///
/// \param library  a shared object, which is laid beside them as "legend.png".
std::vector<std::filesystem::path> write_hostile_maps(const std::filesystem::path& folder,
                                                      const Baits& baits,
                                                      const std::filesystem::path& library);

/// Each driver of GDAL's, asked for by a virtual layer, a virtual raster, a virtual table, and by a
/// connection string that is the whole file.
std::vector<std::filesystem::path> write_generated_maps(const std::filesystem::path& folder,
                                                        const Baits& baits);

/// Connection strings of each driver of GDAL's.
std::vector<std::string> connection_strings(const std::filesystem::path& folder,
                                            const Baits& baits);

/// A database of those statements.
void write_database(const std::filesystem::path& file, const std::string& sql);

/// The statements of a table `t` that is worked out by a module, without the module.
std::string sql_of_virtual_table(const std::string& definition);

} // namespace macadam::testing
