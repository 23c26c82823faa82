#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// Returns a ZIP archive of one uncompressed file, dated 1980-01-01, so that equal content gives
/// equal bytes. (The archives of libarchive do not pass the consistency check of libzip, by which
/// QGIS reads them.)
///
/// Source: PKWARE, APPNOTE.TXT 6.3.10, 4.3.7 (local header), 4.3.12 (central directory), 4.3.16.
///
/// \param name     in UTF-8, at most 65,535 bytes
/// \param content  less than 4 GiB
std::string zip_archive(std::string_view name, std::string_view content);

} // namespace macadam
