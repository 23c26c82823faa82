#pragma once

#include "storage/trips/mappings/column_mapping.hpp"
#include "storage/trips/signals/mdf_blocks.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

/// Channel of a group of an MDF 4 file (block CN).
struct MdfChannel {
    std::string name;
    std::string unit;
    MdfBlock block;
    std::uint8_t type = 0; ///< cn_type, as below
    std::uint8_t data_type = 0;
    std::uint8_t bit_offset = 0;
    std::uint32_t byte_offset = 0;
    std::uint32_t bit_count = 0;
    std::uint32_t flags = 0;
    std::uint32_t invalid_bit = 0;
    /// Formula of raw values: (p1 x^2 + p2 x + p3) / (p4 x^2 + p5 x + p6).
    std::array<double, 6> conversion{0, 1, 0, 0, 0, 1};

    static constexpr std::uint8_t fixed_length = 0;
    static constexpr std::uint8_t variable_length = 1; ///< VLSD: the record has the place of it
    static constexpr std::uint8_t master = 2;
    static constexpr std::uint8_t virtual_master = 3;
    static constexpr std::uint8_t maximum_length = 5; ///< MLSD: another channel has its length
    static constexpr std::uint8_t byte_array = 10;    ///< a data type
};

/// Channel group (block CG), with its records in a data group.
struct MdfGroup {
    std::string name;
    std::uint64_t at; ///< byte of the file
    std::size_t data_group;
    std::uint64_t record_id;
    std::uint16_t flags;
    std::uint32_t data_bytes;
    std::uint32_t invalid_bytes;
    std::vector<MdfChannel> channels;
    std::vector<std::pair<std::uint16_t, std::size_t>> wanted{}; ///< channel of the mapping, ours
    std::size_t time = 0;                                        ///< master channel
    std::uint64_t count = 0;                                     ///< records so far
};

struct MdfDataGroup {
    MdfBlock block;
    std::uint8_t id_bytes;
    bool is_wanted = false;
};

/// Groups and channels of a file.
class MdfLayout {
public:
    explicit MdfLayout(const MdfBlocks& blocks);

    std::vector<MdfDataGroup> data;
    std::vector<MdfGroup> groups;

private:
    void add_group(const MdfBlock& block);
    void add_channels(std::uint64_t first, MdfGroup& group, int nesting);
    bool is_channel(std::uint64_t at) const;

    const MdfBlocks& blocks_;
    std::size_t channels_ = 0;
};

bool is_master(const MdfChannel& channel);

/// Checks that a channel is a number within its records, and reads its conversion.
///
/// \param is_raw  ignores the conversion, such as the names of bits
void prepare(const MdfBlocks& blocks,
             const MdfGroup& group,
             MdfChannel& channel,
             bool is_raw = false);

/// Finds and prepares the master channel of a group that states the time.
/// \throws InputError  if there is none.
std::size_t time_of(const MdfBlocks& blocks, MdfGroup& group);

/// Value of a prepared channel in a record, without its record id; NaN if it is invalid.
double value_in(const MdfGroup& group, const MdfChannel& channel, std::string_view record);

/// UTC of time 0; `std::nullopt` if the file states local time only.
std::optional<double> begin_utc_s(const MdfBlock& head, const TableMapping& mapping);

/// Reads the records of a data group, which may lie over the ends of blocks.
///
/// \param take           group and record, without its record id
/// \param take_variable  group of variable length (VLSD) and its values
void each_record(const MdfBlocks& blocks,
                 MdfLayout& layout,
                 std::size_t data_group,
                 const std::function<void(const MdfGroup&, std::string_view)>& take,
                 const std::function<void(const MdfGroup&, std::string_view)>& take_variable = {});

} // namespace macadam
