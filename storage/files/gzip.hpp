#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// Use of compressed bytes: what is kept is worth more time than what is sent once.
enum class GzipUse { kept, sent_once };

/// Compresses bytes into a gzip member (RFC 1952) without name and time, so that equal input gives
/// equal output.
std::string gzipped(std::string_view bytes, GzipUse use = GzipUse::kept);

/// Decompresses the output of gzipped().
std::string gunzipped(std::string_view bytes);

} // namespace macadam
