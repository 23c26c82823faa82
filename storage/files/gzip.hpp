#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// Compresses bytes into a gzip member (RFC 1952) without name and time, so that equal input gives
/// equal output.
std::string gzipped(std::string_view bytes);

/// Decompresses the output of gzipped().
std::string gunzipped(std::string_view bytes);

} // namespace macadam
