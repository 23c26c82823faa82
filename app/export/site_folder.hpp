#pragma once

#include <filesystem>
#include <ios>
#include <string_view>

namespace macadam {

/// Folder of a site that is not yet in place.
struct SiteFolder {
    std::filesystem::path shown; ///< its name in messages
    std::filesystem::path place;

    /// Writes a file, and the folders above it.
    /// \throws InputError  if it cannot be written.
    void write(const std::filesystem::path& name,
               std::string_view text,
               std::ios::openmode mode = std::ios::trunc) const;

    /// Takes over a file of another folder, whose content never changes.
    /// \returns false if it is missing
    /// \throws InputError  if it cannot be taken over.
    bool take(const std::filesystem::path& file, const std::filesystem::path& name) const;
};

} // namespace macadam
