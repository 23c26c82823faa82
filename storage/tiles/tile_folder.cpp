#include "estimator/common/error.hpp"
#include "storage/files/gzip.hpp"
#include "storage/text/json.hpp"
#include "storage/tiles/tile_index.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

namespace macadam {
namespace {

namespace fs = std::filesystem;

/// Folder under construction: its path, and the name given by the user.
struct Growing {
    const fs::path& at;
    const fs::path& called;
};

[[noreturn]] void fail(const fs::path& file, int error) {
    throw InputError{fmt::format("{}: cannot be written: {}", file.string(), std::strerror(error))};
}

void write_file(const Growing& folder, const fs::path& name, std::string_view bytes) {
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::unique_ptr<std::FILE, Close> file{std::fopen((folder.at / name).c_str(), "wbe")};
    if (!file || std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size() ||
        std::fclose(file.release()) != 0) {
        fail(folder.called / name, errno);
    }
}

void make_folder(const Growing& folder, const fs::path& name) {
    std::error_code error;
    fs::create_directories(folder.at / name, error);
    if (error) {
        fail(folder.called / name, error.value());
    }
}

/// Syncs the whole file system at once: file by file would take a thousand times as long.
void sync(const Growing& folder) {
    const int descriptor = ::open(folder.at.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const int error = descriptor >= 0 && ::syncfs(descriptor) == 0 ? 0 : errno;
    if (descriptor >= 0) {
        ::close(descriptor);
    }
    if (error != 0) {
        fail(folder.called, error);
    }
}

std::string suffix_of(const TileSetNote& note) {
    return note.format == TileSetNote::Format::mvt ? "pbf" : "png";
}

// TileJSON specification 3.0.0; tileSize is MapLibre's.
std::string metadata_of(const TileSetNote& note) {
    const auto& box = note.bounds;
    const auto [middle, zoom] = centre_of(note);
    JsonObject json;
    json.add("tilejson", "3.0.0")
        .add("name", note.name)
        .add("description", note.description)
        .add("attribution", note.attribution)
        .add("scheme", "xyz")
        .add("tiles", JsonRaw{json_string_array({"{z}/{x}/{y}." + suffix_of(note)})})
        .add("minzoom", std::int64_t{note.min_zoom})
        .add("maxzoom", std::int64_t{note.max_zoom})
        .add("bounds",
             JsonRaw{fmt::format("[{:.7f},{:.7f},{:.7f},{:.7f}]",
                                 box.west_deg,
                                 box.south_deg,
                                 box.east_deg,
                                 box.north_deg)})
        .add("center",
             JsonRaw{fmt::format("[{:.7f},{:.7f},{}]", middle.lon_deg, middle.lat_deg, zoom)});
    if (note.format == TileSetNote::Format::mvt) {
        json.add("vector_layers", JsonRaw{layers_json(note.layers)});
    } else {
        json.add("tileSize", std::int64_t{note.tile_px});
    }
    return json.text() + "\n";
}

} // namespace

void write_tile_folder(const fs::path& temporary,
                       const fs::path& called,
                       const TileIndex& contents,
                       const TileSetNote& note,
                       const Progress& progress) {
    constexpr std::size_t report_every = 1000;
    const Growing folder{temporary, called};
    const bool is_vector = note.format == TileSetNote::Format::mvt;
    const auto suffix = suffix_of(note);
    fs::path column_before;
    std::size_t done = 0;
    for (const auto& [number, tile, content] : contents.entries()) {
        if (progress.stop.stop_requested()) {
            throw InputError{"stopped before the folder was complete"};
        }
        const fs::path column = fmt::format("{}/{}", tile.zoom, tile.x);
        if (column != column_before) {
            make_folder(folder, column);
            column_before = column;
        }
        const auto bytes = contents.bytes_of(content);
        write_file(folder,
                   column / fmt::format("{}.{}", tile.y, suffix),
                   is_vector ? gunzipped(bytes) : bytes);
        if (++done % report_every == 0) {
            progress(done, contents.entries().size());
        }
    }
    write_file(folder, "metadata.json", metadata_of(note));
    sync(folder);
}

} // namespace macadam
