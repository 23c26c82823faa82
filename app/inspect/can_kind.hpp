#pragma once

#include "app/inspect/file_kind.hpp"

#include <optional>
#include <string_view>

namespace macadam {

/// Recognises text files of CAN tools: raw logs (Vector ASC, PEAK TRC, candump) and descriptions of
/// signals (DBC). None of them is read: raw frames have no meaning without a description of their
/// signals.
///
/// \param head  first bytes of the file.
/// \returns `std::nullopt` if it is none.
std::optional<FileKind> kind_of_can_text(std::string_view head);

/// Describes a raw log of a CAN bus.
///
/// \param format  "Vector ASC"
FileKind can_log_kind(std::string_view format);

} // namespace macadam
