#pragma once

#include "app/inspect/file_kind.hpp"
#include "storage/trips/detection/text_sample.hpp"

#include <filesystem>
#include <optional>

namespace macadam {

/// Recognises a CSV file of ours by its columns; `std::nullopt` if it is none.
std::optional<FileKind> kind_of_table(const TextSample& sample);

/// Recognises a settings file by its keys, and reads it.
///
/// \throws InputError  "file:line: ..." if it is damaged.
FileKind kind_of_toml(const std::filesystem::path& file);

/// Describes a profile by its tracks and extent.
///
/// \throws InputError  if it is damaged.
FileKind kind_of_profile(const std::filesystem::path& file);

} // namespace macadam
