#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/files/gzip.hpp"
#include "storage/text/json.hpp"
#include "storage/tiles/tile_index.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <string>
#include <vector>

// PMTiles specification, version 3: header (3), directories (4), metadata (5).

namespace macadam {
namespace {

constexpr std::size_t header_bytes = 127;
constexpr std::size_t max_root_bytes = 16384 - header_bytes; // header and root in the first 16 kB

/// Directory entry for consecutive tiles, or, with run = 0, for a leaf directory.
struct DirectoryEntry {
    std::uint64_t number; ///< of the first tile
    std::uint64_t offset;
    std::uint64_t size;
    std::uint64_t run;
};

void put_varint(std::string& bytes, std::uint64_t value) {
    for (; value >= 0x80; value >>= 7U) {
        bytes += static_cast<char>((value & 0x7fU) | 0x80U);
    }
    bytes += static_cast<char>(value);
}

std::string directory_of(std::span<const DirectoryEntry> entries) {
    std::string bytes;
    put_varint(bytes, entries.size());
    std::uint64_t before = 0;
    for (const auto& entry : entries) {
        put_varint(bytes, entry.number - before);
        before = entry.number;
    }
    for (const auto& entry : entries) {
        put_varint(bytes, entry.run);
    }
    for (const auto& entry : entries) {
        put_varint(bytes, entry.size);
    }
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const bool follows =
            i > 0 && entries[i].offset == entries[i - 1].offset + entries[i - 1].size;
        put_varint(bytes, follows ? 0 : entries[i].offset + 1);
    }
    return gzipped(bytes);
}

/// Builds the entries; contents are stored in the order of their first appearance.
std::vector<DirectoryEntry> entries_of(const TileIndex& contents) {
    std::vector<std::uint64_t> offsets(contents.count() + 1, 0);
    for (std::size_t i = 0; i < contents.count(); ++i) {
        offsets[i + 1] = offsets[i] + contents.size_of(i);
    }
    std::vector<DirectoryEntry> entries;
    for (const auto& [number, tile, content] : contents.entries()) {
        if (!entries.empty() && entries.back().offset == offsets[content] &&
            entries.back().number + entries.back().run == number) {
            ++entries.back().run;
        } else {
            entries.push_back({number, offsets[content], contents.size_of(content), 1});
        }
    }
    return entries;
}

struct Directories {
    std::string root;
    std::string leaves; ///< concatenated
};

/// Splits the directory with the fewest tiles per leaf, from 4096 on, for which the root fits.
Directories directories_of(const std::vector<DirectoryEntry>& entries) {
    if (auto root = directory_of(entries); root.size() <= max_root_bytes) {
        return {std::move(root), ""};
    }
    for (std::size_t leaf_entries = 4096;; leaf_entries += leaf_entries / 4) {
        std::string leaves;
        std::vector<DirectoryEntry> root;
        for (std::size_t i = 0; i < entries.size(); i += leaf_entries) {
            const auto of_leaf =
                std::span{entries}.subspan(i, std::min(leaf_entries, entries.size() - i));
            const auto leaf = directory_of(of_leaf);
            root.push_back({of_leaf.front().number, leaves.size(), leaf.size(), 0});
            leaves += leaf;
        }
        if (auto packed = directory_of(root); packed.size() <= max_root_bytes) {
            return {std::move(packed), std::move(leaves)};
        }
    }
}

std::string metadata_of(const TileSetNote& note) {
    JsonObject object;
    object.add("name", note.name)
        .add("description", note.description)
        .add("attribution", note.attribution)
        .add("type", "overlay");
    if (note.format == TileSetNote::Format::mvt) {
        object.add("vector_layers", JsonRaw{layers_json(note.layers)});
    }
    return object.text();
}

/// Little-endian header.
class Header {
public:
    Header() : bytes_{"PMTiles\x03"} {}

    void put(std::uint64_t value, int width) {
        for (int i = 0; i < width; ++i) {
            bytes_ += static_cast<char>(value >> (8U * static_cast<unsigned>(i)));
        }
    }
    void put_degrees(double degrees) {
        put(static_cast<std::uint64_t>(std::llround(degrees * 1e7)), 4);
    }
    const std::string& bytes() const {
        assert(bytes_.size() == header_bytes);
        return bytes_;
    }

private:
    std::string bytes_;
};

struct Sections {
    Directories directories;
    std::string metadata;
    std::uint64_t entries;
};

std::string
header_of(const Sections& sections, const TileIndex& contents, const TileSetNote& note) {
    const bool is_vector = note.format == TileSetNote::Format::mvt;
    Header header;
    std::uint64_t offset = header_bytes;
    for (const auto size : {std::uint64_t{sections.directories.root.size()},
                            std::uint64_t{sections.metadata.size()},
                            std::uint64_t{sections.directories.leaves.size()},
                            contents.bytes()}) {
        header.put(offset, 8);
        header.put(size, 8);
        offset += size;
    }
    header.put(contents.entries().size(), 8);
    header.put(sections.entries, 8);
    header.put(contents.count(), 8);
    header.put(1, 1);                 // clustered: contents lie in the order of their tiles
    header.put(2, 1);                 // directories and metadata: gzip
    header.put(is_vector ? 2 : 1, 1); // tiles: gzip, or uncompressed
    header.put(is_vector ? 1 : 2, 1); // vector tiles, or PNG
    header.put(static_cast<std::uint64_t>(note.min_zoom), 1);
    header.put(static_cast<std::uint64_t>(note.max_zoom), 1);
    const auto [middle, zoom] = centre_of(note);
    header.put_degrees(note.bounds.west_deg);
    header.put_degrees(note.bounds.south_deg);
    header.put_degrees(note.bounds.east_deg);
    header.put_degrees(note.bounds.north_deg);
    header.put(static_cast<std::uint64_t>(zoom), 1);
    header.put_degrees(middle.lon_deg);
    header.put_degrees(middle.lat_deg);
    return header.bytes();
}

} // namespace

void write_pmtiles(AtomicFile& out,
                   const TileIndex& contents,
                   const TileSetNote& note,
                   const Progress& progress) {
    constexpr std::size_t report_every = 1000;
    const auto entries = entries_of(contents);
    const Sections sections{directories_of(entries), gzipped(metadata_of(note)), entries.size()};
    out.write(header_of(sections, contents, note));
    out.write(sections.directories.root);
    out.write(sections.metadata);
    out.write(sections.directories.leaves);
    for (std::size_t i = 0; i < contents.count(); ++i) {
        if (progress.stop.stop_requested()) {
            throw InputError{"stopped before the file was complete"};
        }
        out.write(contents.bytes_of(i));
        if (i % report_every == 0) {
            progress(i, contents.count());
        }
    }
}

} // namespace macadam
