#pragma once

#include "storage/trips/signals/can_frames.hpp"
#include "storage/trips/signals/signal_rows.hpp"

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace macadam {

/// Turns the frames of a bus into rows by the DBC of a mapping, which must outlive it.
class CanDecoder {
public:
    explicit CanDecoder(const TableMapping& mapping);

    /// Adds the row of a frame: its mapped signals, or `unused_channel` if it has none or is of
    /// another bus.
    void add(const CanFrame& frame, SignalRows& rows);

private:
    const TableMapping& mapping_;
    /// Channels by the identifier of their message.
    std::map<std::pair<std::uint32_t, bool>, std::vector<std::uint16_t>> wanted_;
    std::vector<SignalRows::Value> values_;
};

} // namespace macadam
