#pragma once

#include <filesystem>
#include <string>

namespace macadam {

/// Kind of a file, by its first bytes and, where these do not tell, by its name.
struct FileKind {
    enum class Use {
        trip,  ///< the readers of trips take it
        table, ///< a CSV file that is none of ours, perhaps the log of another program
        other, ///< known, see `advice`
        unknown,
    };
    Use use = Use::unknown;
    std::string name{};   ///< "road map (OpenStreetMap, .osm.pbf)"
    std::string advice{}; ///< commands that take it, or what to do instead
};

/// Recognises a file. Content is checked only as far as the kind depends on it.
///
/// \throws InputError  if the file cannot be read.
FileKind kind_of_file(const std::filesystem::path& file);

} // namespace macadam
