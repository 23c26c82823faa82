#include "storage/postgres/ewkb.hpp"

#include <bit>
#include <cstdint>
#include <cstring>

namespace macadam {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr char little_endian = 1;
constexpr std::uint32_t line_with_srid = 0x2000'0002;
constexpr std::uint32_t wgs84 = 4326;
constexpr std::size_t header_size = 13;
constexpr std::size_t point_size = 16;

template <typename Value>
void append(std::string& to, Value value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename Value>
Value value_at(std::string_view bytes, std::size_t at) {
    Value value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

} // namespace

std::string ewkb_of(std::span<const GeoPoint> line) {
    std::string bytes(1, little_endian);
    bytes.reserve(header_size + point_size * line.size());
    append(bytes, line_with_srid);
    append(bytes, wgs84);
    append(bytes, static_cast<std::uint32_t>(line.size()));
    for (const auto& at : line) {
        append(bytes, at.lon_deg);
        append(bytes, at.lat_deg);
    }
    return bytes;
}

std::vector<GeoPoint> line_of_ewkb(std::string_view bytes) {
    if (bytes.size() < header_size || bytes[0] != little_endian ||
        value_at<std::uint32_t>(bytes, 1) != line_with_srid ||
        value_at<std::uint32_t>(bytes, 5) != wgs84) {
        return {};
    }
    const std::size_t points = value_at<std::uint32_t>(bytes, 9);
    if (bytes.size() != header_size + points * point_size) {
        return {};
    }
    std::vector<GeoPoint> line(points);
    for (std::size_t i = 0; i < points; ++i) {
        const auto at = header_size + point_size * i;
        line[i] = {.lat_deg = value_at<double>(bytes, at + 8),
                   .lon_deg = value_at<double>(bytes, at)};
    }
    return line;
}

} // namespace macadam
