#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace macadam::testing {

/// Targets that hostile maps try to reach.
struct Baits {
    std::filesystem::path file; ///< text file outside of the folder of the maps
    std::string url;            ///< port of this machine
};

/// Writes maps that lead their reader to other files, servers and libraries, each by another way,
/// into a folder of their own. Some are complete maps with a hostile element beside or inside.
///
/// \param library  shared object, copied beside them as "legend.png"
std::vector<std::filesystem::path> write_hostile_maps(const std::filesystem::path& folder,
                                                      const Baits& baits,
                                                      const std::filesystem::path& library);

/// Writes maps that request each GDAL driver through a virtual layer, a virtual raster, a virtual
/// table, or a connection string as the whole file.
std::vector<std::filesystem::path> write_generated_maps(const std::filesystem::path& folder,
                                                        const Baits& baits);

/// Returns connection strings for each GDAL driver.
std::vector<std::string> connection_strings(const std::filesystem::path& folder,
                                            const Baits& baits);

/// Writes a database with those statements.
void write_database(const std::filesystem::path& file, const std::string& sql);

/// Returns the SQL of a table `t` of a virtual table module, without the module itself.
std::string sql_of_virtual_table(const std::string& definition);

} // namespace macadam::testing
