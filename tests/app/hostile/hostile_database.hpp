#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace macadam::testing {

/// Ways in which somebody who wishes its readers ill could spoil a database.
enum class Spoiling {
    bytes,   ///< some are overwritten
    pages,   ///< one is copied over another
    length,  ///< cut off, or junk at the end
    cells,   ///< some of a column get a value that is none
    columns, ///< all of a column do
    blobs,   ///< bytes within them are overwritten
    schema,  ///< tables become views, get triggers, lose columns or indices, or are dropped
    masses,  ///< a table gets a hundred thousand rows
    journals ///< files lie beside it that say what was to be written
};

/// Spoils a good database, always in the same way. \returns what was done, for messages.
std::string spoil(const std::filesystem::path& file, Spoiling way, std::uint64_t number);

} // namespace macadam::testing
