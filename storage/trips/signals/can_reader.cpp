#include "storage/trips/signals/can_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/trips/mappings/dbc.hpp"
#include "storage/trips/signals/can_frames.hpp"

#include <fmt/core.h>

#include <map>
#include <utility>

namespace macadam {
namespace {

/// Channels by the identifier of their message.
using Wanted = std::map<std::pair<std::uint32_t, bool>, std::vector<std::uint16_t>>;

Wanted wanted_of(const TableMapping& mapping) {
    Wanted wanted;
    for (std::size_t i = 0; i < mapping.channels.size(); ++i) {
        const auto& message = mapping.dbc->messages[mapping.channels[i].in_dbc.message];
        wanted[{message.id, message.is_extended}].push_back(static_cast<std::uint16_t>(i));
    }
    return wanted;
}

} // namespace

SignalRows read_can(TextLines lines, const TableMapping& mapping, const std::string& name) {
    const auto wanted = wanted_of(mapping);
    SignalRows rows{mapping};
    CanFrames frames{std::move(lines), mapping.time.utc_offset_s};
    std::vector<SignalRows::Value> values;
    std::size_t count = 0;
    std::size_t damaged = 0;
    while (const auto line = frames.next()) {
        const auto& frame = frames.frame();
        const bool is_frame = *line == CanFrames::Line::frame;
        count += is_frame ? 1U : 0U;
        damaged += *line == CanFrames::Line::damaged ? 1U : 0U;
        const bool is_of_bus = mapping.bus.empty() || mapping.bus == frame.bus;
        const auto found =
            is_frame && is_of_bus ? wanted.find({frame.id, frame.is_extended}) : wanted.end();
        if (found == wanted.end()) {
            rows.add(*line == CanFrames::Line::damaged ? RowReason::bad_number
                                                       : RowReason::unused_channel);
            continue;
        }
        values.clear();
        for (const auto channel : found->second) {
            const auto [message, signal] = mapping.channels[channel].in_dbc;
            const auto& described = mapping.dbc->messages[message];
            if (const auto value =
                    signal_value(described, described.signals[signal], frame.data())) {
                values.push_back({channel, *value});
            }
        }
        rows.add(frame.t_s, values);
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
