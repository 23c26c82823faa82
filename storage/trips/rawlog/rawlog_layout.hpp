#pragma once

#include "storage/trips/rawlog/rawlog_head.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

// Layout of objects in a rawlog. MRPT's own reader trusts every count and length, so the extent of
// an object is validated here before MRPT sees it: a broken file cannot make it allocate more than
// the file holds.

/// Size of an object of a known class, including header and end flag; `std::nullopt`: more bytes
/// are needed. 0: it holds unsupported receiver messages, so that its end cannot be determined from
/// within.
///
/// \throws InputError  if the layout does not match its class and version; the message has no
///                     position.
std::optional<std::size_t> rawlog_size(const RawlogHead& head, std::string_view bytes);

/// Removes the unused Topcon fields from an object of a GPS written by MRPT before 1.4, because
/// MRPT 2.5 reads them into freed memory. `std::nullopt`: MRPT may read the object as it is.
std::optional<std::string> without_topcon(std::string_view object);

/// Number of observations in a frame, which begin `size` bytes after the start of the frame.
struct RawlogFrame {
    std::size_t count;
    std::size_t size;
};
std::optional<RawlogFrame> rawlog_frame(const RawlogHead& head, std::string_view bytes);

} // namespace macadam
