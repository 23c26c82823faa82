#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// What to spend on small files.
enum class GzipEffort {
    kept,    ///< what is written once and read often
    passing, ///< what is made for one reader: vector tiles in 0.4 of the time, 12 % larger
};

/// Bytes as a gzip member (RFC 1952) without name and time: the same bytes in, the same out.
std::string gzipped(std::string_view bytes, GzipEffort effort = GzipEffort::kept);

/// What `gzipped` was given. \param bytes  as it gave them.
std::string gunzipped(std::string_view bytes);

} // namespace macadam
