#include "storage/trips/signals/mdf_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/trips/signals/can_decoder.hpp"
#include "storage/trips/signals/mdf_blocks.hpp"
#include "storage/trips/signals/mdf_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

namespace macadam {
namespace {

constexpr std::uint32_t extended_bit = 0x8000'0000; // of an identifier, without a channel IDE
constexpr std::uint32_t id_bits = 0x1FFF'FFFF;
constexpr std::uint32_t max_standard_id = 0x7FF;
constexpr double no_bus = -1;

/// Channels of frames within a group; null: the group has none.
struct FrameGroup {
    const MdfChannel* id = nullptr;
    const MdfChannel* is_extended = nullptr;
    const MdfChannel* bus = nullptr;
    const MdfChannel* length = nullptr;
    const MdfChannel* bytes = nullptr;
    std::uint64_t values_at = 0; ///< of variable length: their block or group
};

/// Frame, with the place of its data among values of variable length.
struct FrameHead {
    double t_s;
    double bus;
    std::uint64_t values_at;
    std::uint64_t place;
    std::uint32_t id;
    bool is_extended;
};

/// Frames of all groups, as rows.
class FrameReader {
public:
    FrameReader(std::string_view bytes, const TableMapping& mapping, const std::string& name)
        : blocks_{bytes, name}, layout_{blocks_}, decoder_{mapping}, rows_{mapping},
          begin_s_{begin_utc_s(blocks_.head(), mapping)} {
        for (auto& group : layout_.groups) {
            find_frames(group);
        }
    }

    SignalRows rows(const TableMapping& mapping, const std::string& name) {
        if (groups_.empty()) {
            throw InputError{fmt::format("{}: has no channel {}, expected frames of a CAN bus that "
                                         "{} describes; omit dbc to read measured channels",
                                         name,
                                         can_frame_id,
                                         mapping.dbc_name)};
        }
        for (std::size_t i = 0; i < layout_.data.size(); ++i) {
            if (layout_.data[i].is_wanted) {
                read_data_group(i);
            }
        }
        add_rows();
        if (rows_.sample_count() == 0) {
            throw InputError{
                fmt::format("{}: {} frames, none of them with a mapped signal, expected "
                            "a log of the bus that {} describes",
                            name,
                            count_,
                            mapping.dbc_name)};
        }
        if (begin_s_) {
            rows_.set_dated();
        }
        rows_.finish();
        return std::move(rows_);
    }

private:
    void find_frames(MdfGroup& group) {
        const auto channel = [&](std::string_view member, bool is_number) {
            const auto found = std::ranges::find(
                group.channels, fmt::format("CAN_DataFrame.{}", member), &MdfChannel::name);
            if (found == group.channels.end()) {
                return static_cast<MdfChannel*>(nullptr);
            }
            if (is_number) {
                prepare(blocks_, group, *found, true);
            }
            return &*found;
        };
        FrameGroup frames{.id = channel("ID", true),
                          .is_extended = channel("IDE", true),
                          .bus = channel("BusChannel", true),
                          .length = channel("DataLength", true),
                          .bytes = channel("DataBytes", false)};
        if (frames.id == nullptr || frames.bytes == nullptr) {
            return;
        }
        expect_bytes(group, *frames.bytes);
        if (frames.bytes->type == MdfChannel::variable_length) {
            frames.values_at = frames.bytes->block.link(5);
            const auto values = blocks_.block(frames.values_at, "SDDZDLHLCG");
            if (values.id != "CG" && !values_.contains(values.at)) {
                auto& all = values_[values.at];
                blocks_.each_data(values.at, [&](std::string_view part) { all += part; });
            }
        }
        group.time = time_of(blocks_, group);
        layout_.data[group.data_group].is_wanted = true;
        groups_.emplace(&group, frames);
    }

    void expect_bytes(const MdfGroup& group, const MdfChannel& bytes) const {
        const bool is_variable = bytes.type == MdfChannel::variable_length;
        const bool is_known = is_variable || bytes.type == MdfChannel::fixed_length ||
                              bytes.type == MdfChannel::maximum_length;
        const std::uint64_t end = std::uint64_t{bytes.byte_offset} + bytes.bit_count / 8;
        if (!is_known || bytes.data_type != MdfChannel::byte_array || bytes.bit_offset != 0 ||
            bytes.bit_count % 8 != 0 || (is_variable && bytes.bit_count != 64) ||
            end > group.data_bytes) {
            blocks_.refuse(bytes.block.at,
                           "the data of frames are no array of bytes within their record");
        }
    }

    void read_data_group(std::size_t i) {
        each_record(
            blocks_,
            layout_,
            i,
            [&](const MdfGroup& group, std::string_view record) {
                if (const auto found = groups_.find(&group); found != groups_.end()) {
                    take(group, found->second, record);
                }
            },
            [&](const MdfGroup& group, std::string_view value) { keep(group, value); });
    }

    /// Adds the rows of all frames by their times: each group has its own.
    void add_rows() {
        std::ranges::stable_sort(frames_, {}, &FrameHead::t_s);
        for (const auto& head : frames_) {
            auto frame = frame_of(head);
            set_bytes(frame, values_[head.values_at], head.place);
            decoder_.add(frame, rows_);
        }
    }

    /// Keeps a value as a block SD has it: behind its length. \returns its place.
    std::uint64_t keep(const MdfGroup& group, std::string_view value) {
        auto& values = values_[group.at];
        const auto place = values.size();
        const auto length = static_cast<std::uint32_t>(value.size());
        std::array<char, sizeof length> head{};
        std::memcpy(head.data(), &length, sizeof length);
        values.append(head.data(), head.size()).append(value);
        return place;
    }

    void take(const MdfGroup& group, const FrameGroup& frames, std::string_view record) {
        ++count_;
        const auto number = [&](const MdfChannel* channel, double fallback) {
            return channel == nullptr ? fallback : value_in(group, *channel, record);
        };
        const double t_s = value_in(group, group.channels[group.time], record);
        const double id = number(frames.id, 0);
        constexpr double past_id = 4294967296; // 2^32
        if (!std::isfinite(t_s)) {
            rows_.add(RowReason::no_time);
            return;
        }
        if (!(id >= 0 && id < past_id)) {
            rows_.add(RowReason::bad_number);
            return;
        }
        const auto bits = static_cast<std::uint32_t>(id);
        const bool may_be_extended = (bits & extended_bit) != 0 || bits > max_standard_id;
        FrameHead head{.t_s = begin_s_.value_or(0) + t_s,
                       .bus = number(frames.bus, no_bus),
                       .values_at = frames.values_at,
                       .place = 0,
                       .id = bits & id_bits,
                       .is_extended = number(frames.is_extended, may_be_extended ? 1 : 0) > 0};
        const auto& bytes = *frames.bytes;
        if (bytes.type == MdfChannel::variable_length) {
            std::memcpy(&head.place, record.data() + bytes.byte_offset, sizeof head.place);
        } else {
            const auto whole = bytes.bit_count / 8;
            const double stated = number(frames.length, whole);
            const auto size =
                stated >= 0 && stated < whole ? static_cast<std::size_t>(stated) : whole;
            head.values_at = group.at;
            head.place = keep(group, record.substr(bytes.byte_offset, size));
        }
        frames_.push_back(head);
    }

    static CanFrame frame_of(const FrameHead& head) {
        return {.t_s = head.t_s,
                .id = head.id,
                .is_extended = head.is_extended,
                .bus = head.bus == no_bus ? std::string{} : fmt::format("{:g}", head.bus)};
    }

    /// Takes the data at a place, or none where the place is wrong: the frame is too short then.
    static void set_bytes(CanFrame& frame, std::string_view values, std::uint64_t place) {
        std::uint32_t length = 0;
        if (place > values.size() || values.size() - place < sizeof length) {
            return;
        }
        std::memcpy(&length, values.data() + place, sizeof length);
        const auto bytes = values.substr(place + sizeof length);
        if (length <= bytes.size()) {
            frame.size =
                static_cast<std::uint8_t>(std::min<std::size_t>(length, frame.bytes.size()));
            std::memcpy(frame.bytes.data(), bytes.data(), frame.size);
        }
    }

    MdfBlocks blocks_;
    MdfLayout layout_;
    CanDecoder decoder_;
    SignalRows rows_;
    std::optional<double> begin_s_;
    std::map<const MdfGroup*, FrameGroup> groups_;
    std::map<std::uint64_t, std::string> values_; ///< of variable length, by block or group
    std::vector<FrameHead> frames_;
    std::size_t count_ = 0;
};

} // namespace

SignalRows
read_mdf_frames(std::string_view bytes, const TableMapping& mapping, const std::string& name) {
    return FrameReader{bytes, mapping, name}.rows(mapping, name);
}

} // namespace macadam
