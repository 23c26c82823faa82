#include "storage/trips/signals/can_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/trips/signals/can_decoder.hpp"
#include "storage/trips/signals/can_frames.hpp"

#include <fmt/core.h>

#include <utility>

namespace macadam {
SignalRows read_can(TextLines lines, const TableMapping& mapping, const std::string& name) {
    CanDecoder decoder{mapping};
    SignalRows rows{mapping};
    CanFrames frames{std::move(lines), mapping.time.utc_offset_s};
    std::size_t count = 0;
    std::size_t damaged = 0;
    while (const auto line = frames.next()) {
        switch (*line) {
        case CanFrames::Line::frame:
            ++count;
            decoder.add(frames.frame(), rows);
            break;
        case CanFrames::Line::damaged:
            ++damaged;
            rows.add(RowReason::bad_number);
            break;
        case CanFrames::Line::other:
            rows.add(RowReason::unused_channel);
            break;
        }
    }
    if (rows.sample_count() == 0) {
        throw InputError{fmt::format(
            "{}: {} frames and {} damaged lines, and no frame with a mapped signal, expected a "
            "candump or Vector ASC log of the bus that {} describes",
            name,
            count,
            damaged,
            mapping.dbc_name)};
    }
    if (frames.dated()) {
        rows.set_dated();
    }
    rows.finish();
    return rows;
}

} // namespace macadam
