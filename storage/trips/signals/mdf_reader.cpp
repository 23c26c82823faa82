#include "storage/trips/signals/mdf_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/spelling.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/signals/mdf_blocks.hpp"
#include "storage/trips/signals/mdf_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {
namespace {

std::string full_name(const MdfGroup& group, const MdfChannel& channel) {
    return group.name.empty() ? channel.name : group.name + "." + channel.name;
}

/// Finds the channel of a mapping.
std::pair<MdfGroup*, std::size_t>
found_channel(MdfLayout& layout, const ChannelMapping& mapped, const std::string& name) {
    const auto& wanted = mapped.column.pattern;
    std::vector<std::pair<MdfGroup*, std::size_t>> found;
    std::vector<std::string> known;
    for (auto& group : layout.groups) {
        for (std::size_t i = 0; i < group.channels.size(); ++i) {
            const auto& channel = group.channels[i];
            if (channel.name == wanted || full_name(group, channel) == wanted) {
                found.emplace_back(&group, i);
            }
            known.push_back(channel.name);
        }
    }
    if (found.empty() && std::ranges::find(known, can_frame_id) != known.end()) {
        throw InputError{
            fmt::format("{}: has no channel {}; it holds frames of a CAN bus, expected a DBC file "
                        "that describes their signals: [mdf] dbc = \"car.dbc\"",
                        name,
                        in_quotes(wanted))};
    }
    if (found.empty()) {
        throw InputError{fmt::format(
            "{}: has no channel {}{}", name, in_quotes(wanted), suggestion(wanted, known))};
    }
    if (found.size() > 1) {
        throw InputError{fmt::format(
            "{}: has {} channels {}, expected the name with that of its "
            "group: {} or {}",
            name,
            found.size(),
            in_quotes(wanted),
            in_quotes(full_name(*found[0].first, found[0].first->channels[found[0].second])),
            in_quotes(full_name(*found[1].first, found[1].first->channels[found[1].second])))};
    }
    return found.front();
}

} // namespace

SignalRows read_mdf(std::string_view bytes, const TableMapping& mapping, const std::string& name) {
    const MdfBlocks blocks{bytes, name};
    MdfLayout layout{blocks};
    SignalRows rows{mapping};
    for (std::size_t i = 0; i < mapping.channels.size(); ++i) {
        const auto& mapped = mapping.channels[i];
        const auto [group, channel] = found_channel(layout, mapped, name);
        prepare(blocks, *group, group->channels[channel]);
        if (group->wanted.empty()) {
            group->time = time_of(blocks, *group);
            layout.data[group->data_group].is_wanted = true;
        }
        group->wanted.emplace_back(static_cast<std::uint16_t>(i), channel);
        rows.take_unit(i, group->channels[channel].unit, name);
    }
    const auto begin_s = begin_utc_s(blocks.head(), mapping);
    std::vector<SignalRows::Value> values;
    for (std::size_t i = 0; i < layout.data.size(); ++i) {
        if (!layout.data[i].is_wanted) {
            continue;
        }
        each_record(blocks, layout, i, [&](const MdfGroup& group, std::string_view record) {
            if (group.wanted.empty()) {
                return;
            }
            const double t_s = value_in(group, group.channels[group.time], record);
            values.clear();
            for (const auto& [channel, ours] : group.wanted) {
                values.push_back({channel, value_in(group, group.channels[ours], record)});
            }
            if (std::isfinite(t_s)) {
                rows.add(begin_s.value_or(0) + t_s, values);
            } else {
                rows.add(RowReason::no_time);
            }
        });
    }
    if (rows.sample_count() == 0) {
        throw InputError{name + ": its mapped channels have no samples"};
    }
    if (begin_s) {
        rows.set_dated();
    }
    rows.finish();
    return rows;
}

std::vector<std::string> mdf_channels(std::string_view bytes, const std::string& name) {
    const MdfBlocks blocks{bytes, name};
    std::vector<std::string> names;
    for (const auto& group : MdfLayout{blocks}.groups) {
        for (const auto& channel : group.channels) {
            if (!is_master(channel)) {
                names.push_back(
                    channel.unit.empty()
                        ? full_name(group, channel)
                        : fmt::format("{} [{}]", full_name(group, channel), channel.unit));
            }
        }
    }
    return names;
}

} // namespace macadam
