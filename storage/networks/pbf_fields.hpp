#pragma once

#include <protozero/pbf_message.hpp>
#include <protozero/types.hpp>

#include <cstdint>
#include <string_view>

namespace macadam {

// Protocol Buffers fields with their expected wire types. A field of another wire type counts as a
// different field and is skipped.

template <typename Tag>
constexpr std::uint32_t number_field(Tag tag) {
    return protozero::tag_and_type(tag, protozero::pbf_wire_type::varint);
}

template <typename Tag>
constexpr std::uint32_t bytes_field(Tag tag) {
    return protozero::tag_and_type(tag, protozero::pbf_wire_type::length_delimited);
}

template <typename Tag>
protozero::pbf_message<Tag> pbf_message(std::string_view bytes) {
    return protozero::pbf_message<Tag>{bytes.data(), bytes.size()};
}

inline std::string_view bytes_of(const protozero::data_view& view) {
    return {view.data(), view.size()};
}

} // namespace macadam
