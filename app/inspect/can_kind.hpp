#pragma once

#include "app/inspect/file_kind.hpp"

#include <filesystem>
#include <optional>
#include <string_view>

namespace macadam {

/// Recognises text files of CAN tools: raw logs (Vector ASC, PEAK TRC, candump) and descriptions of
/// signals (DBC). Raw frames have no meaning without a description of their signals, so that a
/// mapping is needed to read them.
///
/// \param head  first bytes of the file.
/// \returns `std::nullopt` if it is none.
std::optional<FileKind> kind_of_can_text(const std::filesystem::path& file, std::string_view head);

/// Describes an ASAM MDF 4 file with its channels.
///
/// \throws InputError  if it is damaged.
FileKind kind_of_mdf(const std::filesystem::path& file);

/// Describes a raw log of a CAN bus.
///
/// \param format  "Vector ASC"
/// \param is_read  with a mapping
FileKind can_log_kind(std::string_view format, bool is_read);

} // namespace macadam
