#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// Bytes as a gzip member (RFC 1952) without name and time: the same bytes in, the same out.
std::string gzipped(std::string_view bytes);

/// What `gzipped` was given. \param bytes  as it gave them.
std::string gunzipped(std::string_view bytes);

} // namespace macadam
