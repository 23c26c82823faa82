#include "mapping/network/image/network_image.hpp"

#include "estimator/common/error.hpp"
#include "mapping/network/image/network_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

namespace macadam {
namespace {

constexpr std::string_view magic = "macadam\n";
constexpr std::uint32_t image_version = 1;
constexpr std::uint32_t byte_order = 0x01020304;
constexpr std::size_t source_digits = 64;
constexpr std::size_t section_count = 14;

struct Section {
    std::uint64_t offset;
    std::uint64_t count; ///< number of records
};

struct Head {
    std::array<char, 8> magic;
    std::uint32_t byte_order;
    std::uint32_t version;
    std::uint64_t bytes; ///< of the entire image
    double segment_length_m;
    std::array<char, source_digits> source;
    std::array<Section, section_count> sections;
    std::uint64_t sum;      ///< checksum of everything after the header
    std::uint64_t head_sum; ///< checksum of the header before this field
};
static_assert(std::has_unique_object_representations_v<Section>);
static_assert(sizeof(Head) == 32 + source_digits + 16 * section_count + 16);

constexpr std::size_t filled(std::size_t bytes) {
    return (bytes + image_alignment - 1) / image_alignment * image_alignment;
}

constexpr std::size_t head_bytes = filled(sizeof(Head));

/// Calls `visit(array, number)` for each array of the network, in the order of the file.
template <typename Roads, typename Visit>
void for_each_array(Roads& roads, Visit visit) {
    std::size_t number = 0;
    visit(roads.ways, number++);
    visit(roads.points, number++);
    visit(roads.node_ids, number++);
    visit(roads.along_mm, number++);
    visit(roads.links, number++);
    visit(roads.node_point, number++);
    visit(roads.first_out, number++);
    visit(roads.out_edges, number++);
    visit(roads.turn_restrictions, number++);
    visit(roads.turns, number++);
    visit(roads.tree.boxes, number++);
    visit(roads.tree.numbers, number++);
    visit(roads.first_letter, number++);
    visit(roads.letters, number++);
    assert(number == section_count);
}

/// Checksum that detects a changed byte or word; it is no protection against tampering. Four lanes,
/// so that it costs little more than reading.
class Sum {
public:
    /// \param bytes  their number is a multiple of 32 in all but the last call
    void add(std::span<const std::byte> bytes) {
        std::size_t at = 0;
        for (; at + sizeof(strands_) <= bytes.size(); at += sizeof(strands_)) {
            std::array<std::uint64_t, 4> words{};
            std::memcpy(words.data(), bytes.data() + at, sizeof(words));
            for (std::size_t i = 0; i < words.size(); ++i) {
                strands_[i] = mixed(strands_[i], words[i]);
            }
        }
        for (; at < bytes.size(); ++at) {
            strands_[0] = mixed(strands_[0], std::to_integer<std::uint64_t>(bytes[at]));
        }
    }

    std::uint64_t value() const {
        std::uint64_t sum = 0;
        for (const auto strand : strands_) {
            sum = mixed(sum, strand);
        }
        return sum;
    }

private:
    static std::uint64_t mixed(std::uint64_t strand, std::uint64_t word) {
        constexpr std::uint64_t factor = 0x9e3779b97f4a7c15; // 2^64 over the golden ratio, odd
        return std::rotl((strand ^ word) * factor, 29);
    }

    std::array<std::uint64_t, 4> strands_{1, 2, 3, 4};
};

std::uint64_t sum_of(std::span<const std::byte> bytes) {
    Sum sum;
    sum.add(bytes);
    return sum.value();
}

/// Returns the checksum of consecutive sections including their padding.
std::uint64_t sum_of(const std::vector<std::span<const std::byte>>& sections) {
    Sum sum;
    for (const auto& section : sections) {
        const auto whole = section.size() / image_alignment * image_alignment;
        sum.add(section.first(whole));
        std::array<std::byte, image_alignment> rest{};
        std::ranges::copy(section.subspan(whole), rest.begin());
        if (whole < section.size()) {
            sum.add(rest);
        }
    }
    return sum.value();
}

std::uint64_t sum_of(const Head& head) {
    return sum_of(std::as_bytes(std::span{&head, 1}).first(offsetof(Head, head_sum)));
}

/// \param begin  required start of the section. \returns the start of the next one.
template <typename Value>
std::size_t look_into(std::span<const Value>& array,
                      const Section& section,
                      std::size_t begin,
                      std::span<const std::byte> image) {
    static_assert(std::is_trivially_copyable_v<Value>);
    if (section.offset != begin || begin > image.size() ||
        section.count > (image.size() - begin) / sizeof(Value)) {
        throw InputError{"its parts exceed the file, expected a complete network file"};
    }
    array = {reinterpret_cast<const Value*>(image.data() + begin), section.count};
    return begin + filled(section.count * sizeof(Value));
}

Head head_in(std::span<const std::byte> image) {
    Head head{};
    if (!begins_as_image(image)) {
        throw InputError{"is not a Macadam network file"};
    }
    if (image.size() < head_bytes) {
        throw InputError{fmt::format(
            "has {} bytes, expected at least {}: it is truncated", image.size(), head_bytes)};
    }
    std::memcpy(&head, image.data(), sizeof(head));
    if (head.byte_order != byte_order) {
        throw InputError{"was written on a machine with another byte order"};
    }
    if (head.version != image_version) {
        throw InputError{fmt::format(
            "is a network file of version '{}', expected version {}", head.version, image_version)};
    }
    const bool is_filled_up =
        std::ranges::all_of(image.first(head_bytes).subspan(sizeof(head)),
                            [](std::byte byte) { return byte == std::byte{0}; });
    if (head.head_sum != sum_of(head) || !is_filled_up) {
        throw InputError{"is damaged: the checksum of its header differs"};
    }
    if (head.bytes != image.size()) {
        throw InputError{
            fmt::format("has {} bytes, expected {}: it is truncated", image.size(), head.bytes)};
    }
    return head;
}

} // namespace

NetworkImage image_of(const RoadNetwork& roads, std::string_view source) {
    assert(source.size() == source_digits);
    NetworkImage image;
    Head head{};
    std::ranges::copy(magic, head.magic.begin());
    head.byte_order = byte_order;
    head.version = image_version;
    head.segment_length_m = roads.segment_length_m;
    std::ranges::copy(source, head.source.begin());
    head.bytes = head_bytes;
    for_each_array(roads, [&](const auto& array, std::size_t number) {
        const auto bytes = std::as_bytes(array);
        head.sections[number] = {head.bytes, array.size()};
        head.bytes += filled(bytes.size());
        image.sections.push_back(bytes);
    });
    head.sum = sum_of(image.sections);
    head.head_sum = sum_of(head);
    image.head.assign(head_bytes, '\0');
    std::memcpy(image.head.data(), &head, sizeof(head));
    return image;
}

bool begins_as_image(std::span<const std::byte> bytes) {
    return bytes.size() >= magic.size() &&
           std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

ImageContent network_in(std::span<const std::byte> image, std::shared_ptr<const void> owner) {
    const auto head = head_in(image);
    if (sum_of(image.subspan(head_bytes)) != head.sum) {
        throw InputError{"is damaged: its checksum differs"};
    }
    RoadNetwork roads;
    auto begin = head_bytes;
    for_each_array(roads, [&](auto& array, std::size_t number) {
        begin = look_into(array, head.sections[number], begin, image);
    });
    if (begin != image.size()) {
        throw InputError{"its parts do not fill the file, expected a complete network file"};
    }
    roads.segment_length_m = head.segment_length_m;
    expect_sound(roads);
    roads.owner = std::move(owner);
    return {std::move(roads), std::string{head.source.data(), head.source.size()}};
}

} // namespace macadam
