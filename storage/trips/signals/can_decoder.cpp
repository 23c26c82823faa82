#include "storage/trips/signals/can_decoder.hpp"

#include "storage/trips/mappings/dbc.hpp"

namespace macadam {

CanDecoder::CanDecoder(const TableMapping& mapping) : mapping_{mapping} {
    for (std::size_t i = 0; i < mapping.channels.size(); ++i) {
        const auto& message = mapping.dbc->messages[mapping.channels[i].in_dbc.message];
        wanted_[{message.id, message.is_extended}].push_back(static_cast<std::uint16_t>(i));
    }
}

void CanDecoder::add(const CanFrame& frame, SignalRows& rows) {
    const bool is_of_bus = mapping_.bus.empty() || mapping_.bus == frame.bus;
    const auto found = is_of_bus ? wanted_.find({frame.id, frame.is_extended}) : wanted_.end();
    if (found == wanted_.end()) {
        rows.add(RowReason::unused_channel);
        return;
    }
    values_.clear();
    for (const auto channel : found->second) {
        const auto [message, signal] = mapping_.channels[channel].in_dbc;
        const auto& described = mapping_.dbc->messages[message];
        if (const auto value = signal_value(described, described.signals[signal], frame.data())) {
            values_.push_back({channel, *value});
        }
    }
    rows.add(frame.t_s, values_);
}

} // namespace macadam
