#include "pmtiles_reader.hpp"

#include <zlib.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

namespace macadam::testing {
namespace {

struct Entry {
    std::uint64_t tile, run, size, offset;
};

std::uint64_t number_at(const std::string& bytes, std::size_t at, std::size_t width) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < width; ++i) {
        value |= std::uint64_t{static_cast<unsigned char>(bytes.at(at + i))} << (8 * i);
    }
    return value;
}

double degrees_at(const std::string& bytes, std::size_t at) {
    return static_cast<std::int32_t>(number_at(bytes, at, 4)) / 1e7;
}

std::uint64_t take_varint(const std::string& bytes, std::size_t& at) {
    std::uint64_t value = 0;
    for (unsigned shift = 0;; shift += 7) {
        const auto byte = static_cast<unsigned char>(bytes.at(at++));
        value |= std::uint64_t{byte & 0x7fU} << shift;
        if (byte < 0x80) {
            return value;
        }
    }
}

std::vector<Entry> directory_in(const std::string& packed) {
    const auto bytes = unzipped(packed);
    std::size_t at = 0;
    std::vector<Entry> entries(take_varint(bytes, at));
    std::uint64_t tile = 0;
    for (auto& entry : entries) {
        entry.tile = tile += take_varint(bytes, at);
    }
    for (auto& entry : entries) {
        entry.run = take_varint(bytes, at);
    }
    for (auto& entry : entries) {
        entry.size = take_varint(bytes, at);
    }
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const auto offset = take_varint(bytes, at);
        entries[i].offset =
            offset == 0 ? entries.at(i - 1).offset + entries.at(i - 1).size : offset - 1;
    }
    if (at != bytes.size()) {
        throw std::runtime_error{"a directory is longer than what it tells"};
    }
    return entries;
}

/// The way back along the curve: from a place on it to a square, from the smallest square up.
TileId tile_at(std::uint64_t number) {
    std::uint8_t zoom = 0;
    for (std::uint64_t tiles = 1; number >= tiles; tiles *= 4) {
        number -= tiles;
        ++zoom;
    }
    std::uint64_t x = 0, y = 0;
    for (std::uint64_t side = 1; side < (std::uint64_t{1} << zoom); side *= 2, number /= 4) {
        const auto east = (number / 2) & 1U, south = (number ^ east) & 1U;
        if (south == 0) {
            if (east == 1) {
                x = side - 1 - x;
                y = side - 1 - y;
            }
            std::swap(x, y);
        }
        x += side * east;
        y += side * south;
    }
    return {zoom, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)};
}

} // namespace

std::string unzipped(const std::string& packed) {
    z_stream stream{};
    if (inflateInit2(&stream, 15 + 16) != Z_OK) { // 16: only gzip
        throw std::runtime_error{"zlib"};
    }
    std::string bytes, room(1U << 16U, '\0');
    auto from = packed;
    stream.next_in = reinterpret_cast<Bytef*>(from.data());
    stream.avail_in = static_cast<uInt>(from.size());
    int code = Z_OK;
    while (code == Z_OK) {
        stream.next_out = reinterpret_cast<Bytef*>(room.data());
        stream.avail_out = static_cast<uInt>(room.size());
        code = inflate(&stream, Z_NO_FLUSH);
        bytes.append(room, 0, room.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    if (code != Z_STREAM_END || stream.avail_in != 0) {
        throw std::runtime_error{"no gzip member"};
    }
    return bytes;
}

ReadPmTiles read_pmtiles(const std::filesystem::path& file) {
    std::ifstream in{file, std::ios::binary};
    const std::string bytes{std::istreambuf_iterator<char>{in}, {}};
    if (bytes.compare(0, 8, "PMTiles\x03") != 0) {
        throw std::runtime_error{"no PMTiles of version 3"};
    }
    const auto section = [&](std::size_t at) {
        return bytes.substr(number_at(bytes, at, 8), number_at(bytes, at + 8, 8));
    };
    ReadPmTiles read{.tiles = {},
                     .metadata = unzipped(section(24)),
                     .addressed_tiles = number_at(bytes, 72, 8),
                     .entries = number_at(bytes, 80, 8),
                     .contents = number_at(bytes, 88, 8),
                     .clustered = bytes.at(96) == 1,
                     .tile_compression = bytes.at(98),
                     .tile_type = bytes.at(99),
                     .min_zoom = bytes.at(100),
                     .max_zoom = bytes.at(101),
                     .west_deg = degrees_at(bytes, 102),
                     .south_deg = degrees_at(bytes, 106),
                     .east_deg = degrees_at(bytes, 110),
                     .north_deg = degrees_at(bytes, 114),
                     .centre_zoom = bytes.at(118),
                     .root_ends_at = number_at(bytes, 8, 8) + number_at(bytes, 16, 8)};
    const auto leaves = section(40), data = section(56);
    const auto take_tiles = [&](const std::vector<Entry>& entries) {
        for (const auto& entry : entries) {
            for (std::uint64_t i = 0; i < entry.run; ++i) {
                read.tiles[tile_at(entry.tile + i)] = data.substr(entry.offset, entry.size);
            }
        }
    };
    const auto root = directory_in(section(8));
    take_tiles(root);
    for (const auto& entry : root) {
        if (entry.run == 0) {
            take_tiles(directory_in(leaves.substr(entry.offset, entry.size)));
            ++read.leaves;
        }
    }
    return read;
}

std::string grey_png(std::uint32_t size_px, std::uint8_t grey) {
    const auto big_endian = [](std::uint32_t value) {
        return std::string{static_cast<char>(value >> 24U),
                           static_cast<char>(value >> 16U),
                           static_cast<char>(value >> 8U),
                           static_cast<char>(value)};
    };
    const auto chunk = [&](const std::string& kind, const std::string& content) {
        const auto text = kind + content;
        const auto crc =
            crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size()));
        return big_endian(static_cast<std::uint32_t>(content.size())) + text +
               big_endian(static_cast<std::uint32_t>(crc));
    };
    std::string rows;
    for (std::uint32_t i = 0; i < size_px; ++i) {
        rows += '\0' + std::string(size_px, static_cast<char>(grey));
    }
    std::string packed(compressBound(rows.size()), '\0');
    auto size = static_cast<uLongf>(packed.size());
    compress(reinterpret_cast<Bytef*>(packed.data()),
             &size,
             reinterpret_cast<const Bytef*>(rows.data()),
             rows.size());
    packed.resize(size);
    const std::string eight_bits_grey{"\x08\0\0\0\0", 5};
    return "\x89PNG\r\n\x1a\n" +
           chunk("IHDR", big_endian(size_px) + big_endian(size_px) + eight_bits_grey) +
           chunk("IDAT", packed) + chunk("IEND", "");
}

} // namespace macadam::testing
