
#include "storage/geopackage/geopackage_geometry.hpp"

#include <sqlite3.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

namespace macadam {
namespace {

static_assert(std::endian::native == std::endian::little); // byte order of the file

// OGC 12-128r18, table 5 (GeoPackageBinary header) and OGC 06-103r4, 8.2 (well-known binary).
constexpr std::uint8_t header_flags = 0x03; // little endian, envelope of min x, max x, min y, max y
constexpr std::uint8_t empty_flag = 0x10;
constexpr std::int32_t srs_id = 4326;
constexpr std::size_t header_bytes = 8;
constexpr std::size_t envelope_bytes = 4 * sizeof(double);
constexpr std::uint32_t wkb_point = 1;
constexpr std::uint32_t wkb_line_string = 2;
constexpr std::size_t line_head_bytes = 1 + 2 * sizeof(std::uint32_t);
constexpr std::size_t point_bytes = 2 * sizeof(double);

template <typename Number>
void append(std::string& bytes, Number number) {
    char raw[sizeof(Number)];
    std::memcpy(raw, &number, sizeof(Number));
    bytes.append(raw, sizeof(Number));
}

template <typename Number>
Number number_at(std::string_view bytes, std::size_t place) {
    Number number;
    std::memcpy(&number, bytes.data() + place, sizeof(Number));
    return number;
}

/// Header, envelope, byte order and type of a geometry with these points.
std::string head_of(std::span<const GeoPoint> points, std::uint32_t type) {
    GeoBox box;
    for (const auto& point : points) {
        box = including(box, point);
    }
    std::string bytes{"GP\0", 3};
    bytes.reserve(header_bytes + envelope_bytes + line_head_bytes + points.size() * point_bytes);
    append(bytes, header_flags);
    append(bytes, srs_id);
    for (const double value : {box.west_deg, box.east_deg, box.south_deg, box.north_deg}) {
        append(bytes, value);
    }
    append(bytes, std::uint8_t{1}); // little endian
    append(bytes, type);
    return bytes;
}

/// Tests for a geometry in the form that we write; others do not occur in our tables.
bool is_ours(std::string_view geometry) {
    return geometry.size() >= header_bytes + envelope_bytes + line_head_bytes &&
           geometry.substr(0, 3) == std::string_view{"GP\0", 3} &&
           (static_cast<std::uint8_t>(geometry[3]) & ~empty_flag) == header_flags;
}

/// n-th number of the envelope.
std::optional<double> limit(std::string_view geometry, std::size_t n) {
    if (!is_ours(geometry)) {
        return std::nullopt;
    }
    const auto value = number_at<double>(geometry, header_bytes + n * sizeof(double));
    return std::isnan(value) ? std::nullopt : std::optional{value};
}

std::string_view bytes_of(sqlite3_value* value) {
    const auto* bytes = static_cast<const char*>(sqlite3_value_blob(value));
    const auto size = static_cast<std::size_t>(sqlite3_value_bytes(value));
    return bytes == nullptr ? std::string_view{} : std::string_view{bytes, size};
}

template <std::size_t n>
void st_limit(sqlite3_context* context, int, sqlite3_value** values) {
    if (const auto value = limit(bytes_of(values[0]), n)) {
        sqlite3_result_double(context, *value);
    } else {
        sqlite3_result_null(context);
    }
}

void st_is_empty(sqlite3_context* context, int, sqlite3_value** values) {
    sqlite3_result_int(context, limit(bytes_of(values[0]), 0) ? 0 : 1);
}

struct GeometryFunction {
    const char* name;
    void (*body)(sqlite3_context*, int, sqlite3_value**);
};

constexpr GeometryFunction geometry_functions[] = {{"ST_MinX", st_limit<0>},
                                                   {"ST_MaxX", st_limit<1>},
                                                   {"ST_MinY", st_limit<2>},
                                                   {"ST_MaxY", st_limit<3>},
                                                   {"ST_IsEmpty", st_is_empty}};

} // namespace

void add_geometry_functions(Database& database) {
    for (const auto& [name, body] : geometry_functions) {
        // Innocuous, so that triggers can call them in an untrusted schema.
        sqlite3_create_function_v2(database.handle(),
                                   name,
                                   1,
                                   SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_INNOCUOUS,
                                   nullptr,
                                   body,
                                   nullptr,
                                   nullptr,
                                   nullptr);
    }
}

std::string geometry_of(const GeoPoint& point) {
    auto bytes = head_of({&point, 1}, wkb_point);
    append(bytes, point.lon_deg);
    append(bytes, point.lat_deg);
    return bytes;
}

std::string geometry_of(std::span<const GeoPoint> line) {
    auto bytes = head_of(line, wkb_line_string);
    append(bytes, static_cast<std::uint32_t>(line.size()));
    for (const auto& point : line) {
        append(bytes, point.lon_deg);
        append(bytes, point.lat_deg);
    }
    return bytes;
}

std::optional<GeoBox> box_of_geometry(std::string_view geometry) {
    const auto west = limit(geometry, 0);
    if (!west) {
        return std::nullopt;
    }
    const auto at = [&](std::size_t n) {
        return number_at<double>(geometry, header_bytes + n * sizeof(double));
    };
    return GeoBox{.west_deg = *west, .south_deg = at(2), .east_deg = at(1), .north_deg = at(3)};
}

std::vector<GeoPoint> line_of_geometry(std::string_view geometry) {
    std::vector<GeoPoint> line;
    put_line_of_geometry(geometry, line);
    return line;
}

void put_line_of_geometry(std::string_view geometry, std::vector<GeoPoint>& line) {
    constexpr std::size_t head = header_bytes + envelope_bytes;
    line.clear();
    if (!is_ours(geometry) || number_at<std::uint32_t>(geometry, head + 1) != wkb_line_string) {
        return;
    }
    const auto count = number_at<std::uint32_t>(geometry, head + 1 + sizeof(std::uint32_t));
    if (geometry.size() != head + line_head_bytes + count * point_bytes) {
        return;
    }
    line.reserve(count);
    for (std::size_t place = head + line_head_bytes; place < geometry.size();
         place += point_bytes) {
        line.push_back({.lat_deg = number_at<double>(geometry, place + sizeof(double)),
                        .lon_deg = number_at<double>(geometry, place)});
    }
}

} // namespace macadam
