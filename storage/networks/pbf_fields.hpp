#pragma once

#include <protozero/pbf_message.hpp>
#include <protozero/types.hpp>

#include <cstdint>
#include <string_view>

namespace macadam {

// Fields of messages in Protocol Buffers with the types that they must have: one of another type
// is another field, to be passed over.

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
