#include "storage/trips/signals/mdf_layout.hpp"

#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t max_channels = 1'000'000;
constexpr int max_nesting = 8;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Values of cn_sync_type, cn_data_type, cg_flags, cn_flags, hd_time_flags.
constexpr std::uint8_t time_sync = 1;
constexpr std::uint8_t last_number_type = 5;
constexpr std::uint16_t vlsd_group = 1;
constexpr std::uint32_t all_invalid = 1;
constexpr std::uint32_t has_invalid_bit = 2;
constexpr std::uint8_t local_time = 1;

std::uint64_t raw_bits(const MdfChannel& channel, std::string_view record) {
    const std::size_t count = (channel.bit_offset + channel.bit_count + 7) / 8;
    const bool is_big_endian = channel.data_type % 2 == 1;
    std::uint64_t low = 0;
    std::uint64_t high = 0; // of nine bytes
    for (std::size_t i = 0; i < count; ++i) {
        const auto from = is_big_endian ? count - 1 - i : i;
        const auto byte = static_cast<std::uint8_t>(record[channel.byte_offset + from]);
        if (i < 8) {
            low |= std::uint64_t{byte} << (8 * i);
        } else {
            high = byte;
        }
    }
    if (channel.bit_offset > 0) {
        low = (low >> channel.bit_offset) | (high << (64 - channel.bit_offset));
    }
    return channel.bit_count < 64 ? low & ((std::uint64_t{1} << channel.bit_count) - 1) : low;
}

/// Cuts the data of a data group into records, which may lie over the ends of blocks.
class MdfRecords {
public:
    MdfRecords(const MdfBlocks& blocks, const MdfDataGroup& data, std::vector<MdfGroup*> groups)
        : blocks_{blocks}, data_{data}, groups_{std::move(groups)} {}

    using Take = std::function<void(const MdfGroup&, std::string_view)>;

    void each(const Take& take, const Take& take_variable) {
        blocks_.each_data(data_.block.link(2), [&](std::string_view bytes) {
            std::string joined;
            if (!rest_.empty()) {
                joined = rest_;
                joined += bytes;
                bytes = joined;
            }
            while (const auto size = record_size(bytes)) {
                const bool is_variable = (group_->flags & vlsd_group) != 0;
                const auto head = data_.id_bytes + (is_variable ? sizeof(std::uint32_t) : 0);
                if (const auto& taker = is_variable ? take_variable : take) {
                    taker(*group_, bytes.substr(head, size - head));
                }
                ++group_->count;
                bytes.remove_prefix(size);
            }
            rest_ = std::string{bytes};
        });
    }

private:
    /// Size of the first record, 0 if it is not whole; `group_` becomes its group.
    std::size_t record_size(std::string_view bytes) {
        std::uint64_t id = 0;
        if (bytes.size() < std::max<std::size_t>(data_.id_bytes, 1)) {
            return 0;
        }
        std::memcpy(&id, bytes.data(), data_.id_bytes);
        const auto found = data_.id_bytes == 0
                               ? groups_.begin()
                               : std::ranges::find(groups_, id, &MdfGroup::record_id);
        if (found == groups_.end()) {
            blocks_.refuse(data_.block.at,
                           fmt::format("its data have a record of an unknown group {}", id));
        }
        std::size_t size = data_.id_bytes;
        group_ = *found;
        if ((group_->flags & vlsd_group) != 0) {
            std::uint32_t length = 0;
            if (bytes.size() - size < sizeof length) {
                return 0;
            }
            std::memcpy(&length, bytes.data() + size, sizeof length);
            size += sizeof length + length;
        } else {
            size += std::size_t{group_->data_bytes} + group_->invalid_bytes;
        }
        if (size == 0) {
            blocks_.refuse(data_.block.at, "its records are empty");
        }
        return size <= bytes.size() ? size : 0;
    }

    const MdfBlocks& blocks_;
    const MdfDataGroup& data_;
    std::vector<MdfGroup*> groups_;
    MdfGroup* group_ = nullptr;
    std::string rest_;
};

} // namespace

MdfLayout::MdfLayout(const MdfBlocks& blocks) : blocks_{blocks} {
    for (const auto& block : blocks.chain(blocks.head().link(0), "DG")) {
        const auto id_bytes = block.number<std::uint8_t>(0);
        if (id_bytes > 8 || (id_bytes & (id_bytes - 1)) != 0) {
            blocks.refuse(block.at, "a record id of an unknown size");
        }
        for (const auto& group : blocks.chain(block.link(1), "CG")) {
            add_group(group);
        }
        data.push_back({block, id_bytes});
    }
}

void MdfLayout::add_group(const MdfBlock& block) {
    MdfGroup group{.name = blocks_.text(block.link(2)),
                   .at = block.at,
                   .data_group = data.size(),
                   .record_id = block.number<std::uint64_t>(0),
                   .flags = block.number<std::uint16_t>(16),
                   .data_bytes = block.number<std::uint32_t>(24),
                   .invalid_bytes = block.number<std::uint32_t>(28),
                   .channels = {}};
    add_channels(block.link(1), group, 0);
    groups.push_back(std::move(group));
}

/// Adds channels, and those that they are composed of.
void MdfLayout::add_channels(std::uint64_t first, MdfGroup& group, int nesting) {
    for (const auto& block : blocks_.chain(first, "CN")) {
        if (++channels_ > max_channels) {
            blocks_.refuse(block.at, "too many channels, expected at most a million");
        }
        MdfChannel channel{.name = blocks_.text(block.link(2)),
                           .unit = blocks_.text(block.link(6)),
                           .block = block,
                           .type = block.number<std::uint8_t>(0),
                           .data_type = block.number<std::uint8_t>(2),
                           .bit_offset = block.number<std::uint8_t>(3),
                           .byte_offset = block.number<std::uint32_t>(4),
                           .bit_count = block.number<std::uint32_t>(8),
                           .flags = block.number<std::uint32_t>(12),
                           .invalid_bit = block.number<std::uint32_t>(16)};
        if (channel.unit.empty() && block.link(4) != 0) {
            channel.unit = blocks_.text(blocks_.block(block.link(4), "CC").link(1));
        }
        group.channels.push_back(std::move(channel));
        if (const auto parts = block.link(1); parts != 0 && nesting < max_nesting) {
            if (is_channel(parts)) {
                add_channels(parts, group, nesting + 1);
            }
        }
    }
}

bool MdfLayout::is_channel(std::uint64_t at) const {
    return blocks_.block(at, "CNCA").id == "CN";
}

bool is_master(const MdfChannel& channel) {
    return channel.type == MdfChannel::master || channel.type == MdfChannel::virtual_master;
}

/// Checks that a channel is a number within its records, and reads its conversion.
void prepare(const MdfBlocks& blocks, const MdfGroup& group, MdfChannel& channel, bool is_raw) {
    const auto where = fmt::format("channel {}", in_quotes(channel.name));
    const bool is_virtual = channel.type == MdfChannel::virtual_master;
    const bool is_number = channel.data_type <= last_number_type &&
                           (channel.type == 0 || is_master(channel)) && channel.bit_count <= 64;
    const bool is_float = channel.data_type >= 4;
    const bool float_fits = !is_float || ((channel.bit_count == 32 || channel.bit_count == 64) &&
                                          channel.bit_offset == 0);
    if (!is_number || channel.bit_offset > 7 ||
        (!is_virtual && (channel.bit_count == 0 || !float_fits))) {
        blocks.refuse(channel.block.at, where + " is no number, expected an integer or float");
    }
    const std::uint64_t bytes = (std::uint64_t{channel.bit_offset} + channel.bit_count + 7) / 8;
    const bool invalid_fits =
        (channel.flags & has_invalid_bit) == 0 || channel.invalid_bit / 8 < group.invalid_bytes;
    if ((!is_virtual && channel.byte_offset + bytes > group.data_bytes) || !invalid_fits) {
        blocks.refuse(channel.block.at, where + " lies outside of its record");
    }
    const auto at = channel.block.link(4);
    if (at == 0 || is_raw) {
        return;
    }
    const auto conversion = blocks.block(at, "CC");
    const auto kind = conversion.number<std::uint8_t>(0);
    const auto count = conversion.number<std::uint16_t>(6);
    const auto value = [&](std::size_t i) { return conversion.number<double>(24 + 8 * i); };
    if (kind == 1 && count >= 2) {
        channel.conversion = {0, value(1), value(0), 0, 0, 1};
    } else if (kind == 2 && count >= 6) {
        channel.conversion = {value(0), value(1), value(2), value(3), value(4), value(5)};
    } else if (kind != 0) {
        blocks.refuse(at,
                      where + fmt::format(" has a conversion of type {}, expected a linear or "
                                          "rational one",
                                          kind));
    }
}

double value_in(const MdfGroup& group, const MdfChannel& channel, std::string_view record) {
    if ((channel.flags & all_invalid) != 0) {
        return unknown;
    }
    if ((channel.flags & has_invalid_bit) != 0) {
        const auto byte = record[group.data_bytes + channel.invalid_bit / 8];
        if (((static_cast<std::uint8_t>(byte) >> (channel.invalid_bit % 8)) & 1U) != 0) {
            return unknown;
        }
    }
    double x = 0;
    if (channel.type == MdfChannel::virtual_master) {
        x = static_cast<double>(group.count);
    } else {
        const auto raw = raw_bits(channel, record);
        const auto unused = 64 - channel.bit_count;
        if (channel.data_type >= 4) {
            x = channel.bit_count == 32
                    ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)))
                    : std::bit_cast<double>(raw);
        } else if (channel.data_type >= 2) {
            x = static_cast<double>(static_cast<std::int64_t>(raw << unused) >> unused);
        } else {
            x = static_cast<double>(raw);
        }
    }
    const auto& p = channel.conversion;
    return ((p[0] * x + p[1]) * x + p[2]) / ((p[3] * x + p[4]) * x + p[5]);
}

/// Master channel of a group that states the time.
std::size_t time_of(const MdfBlocks& blocks, MdfGroup& group) {
    for (std::size_t i = 0; i < group.channels.size(); ++i) {
        const auto& channel = group.channels[i];
        if (is_master(channel) && channel.block.number<std::uint8_t>(1) == time_sync) {
            prepare(blocks, group, group.channels[i]);
            return i;
        }
    }
    blocks.refuse(
        group.channels.front().block.at,
        fmt::format("the group {} has no master channel with the time", in_quotes(group.name)));
}

/// UTC of time 0; `std::nullopt` if the file states local time only.
std::optional<double> begin_utc_s(const MdfBlock& head, const TableMapping& mapping) {
    const double begin_s = static_cast<double>(head.number<std::uint64_t>(0)) * 1e-9;
    const bool is_local = (head.number<std::uint8_t>(12) & local_time) != 0;
    if (begin_s == 0 || (is_local && !mapping.time.utc_offset_s)) {
        return std::nullopt;
    }
    return is_local ? begin_s - *mapping.time.utc_offset_s : begin_s;
}

void each_record(const MdfBlocks& blocks,
                 MdfLayout& layout,
                 std::size_t data_group,
                 const std::function<void(const MdfGroup&, std::string_view)>& take,
                 const std::function<void(const MdfGroup&, std::string_view)>& take_variable) {
    std::vector<MdfGroup*> groups;
    for (auto& group : layout.groups) {
        if (group.data_group == data_group) {
            groups.push_back(&group);
        }
    }
    MdfRecords{blocks, layout.data[data_group], std::move(groups)}.each(take, take_variable);
}

} // namespace macadam
