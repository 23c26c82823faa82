#include "estimator/common/error.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/text/json.hpp"
#include "storage/tiles/tile_index.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

// MBTiles specification 1.3. Equal tiles, such as empty ones, are stored once: `tiles` is a view,
// as the specification allows.
constexpr const char* tables = R"(
PRAGMA application_id = 0x4d504258;
CREATE TABLE metadata (name TEXT NOT NULL PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE map (
    zoom_level INTEGER NOT NULL,
    tile_column INTEGER NOT NULL,
    tile_row INTEGER NOT NULL,
    tile_id INTEGER NOT NULL REFERENCES images(tile_id),
    PRIMARY KEY (zoom_level, tile_column, tile_row)
) WITHOUT ROWID;
CREATE TABLE images (tile_id INTEGER PRIMARY KEY NOT NULL, tile_data BLOB NOT NULL);
CREATE VIEW tiles AS
    SELECT map.zoom_level AS zoom_level, map.tile_column AS tile_column, map.tile_row AS tile_row,
           images.tile_data AS tile_data
    FROM map JOIN images ON images.tile_id = map.tile_id;
)";

std::string degrees(const GeoBox& box) {
    return fmt::format(
        "{:.7f},{:.7f},{:.7f},{:.7f}", box.west_deg, box.south_deg, box.east_deg, box.north_deg);
}

std::vector<std::pair<std::string, std::string>> metadata_of(const TileSetNote& note) {
    const bool is_vector = note.format == TileSetNote::Format::mvt;
    const auto [middle, zoom] = centre_of(note);
    std::vector<std::pair<std::string, std::string>> rows{
        {"name", note.name},
        {"format", is_vector ? "pbf" : "png"},
        {"bounds", degrees(note.bounds)},
        {"center", fmt::format("{:.7f},{:.7f},{}", middle.lon_deg, middle.lat_deg, zoom)},
        {"minzoom", fmt::format("{}", note.min_zoom)},
        {"maxzoom", fmt::format("{}", note.max_zoom)},
        {"attribution", note.attribution},
        {"description", note.description},
        {"type", "overlay"}};
    if (is_vector) {
        JsonObject json;
        json.add("vector_layers", JsonRaw{layers_json(note.layers)});
        rows.emplace_back("json", json.text());
    }
    return rows;
}

} // namespace

void write_mbtiles(const std::filesystem::path& temporary,
                   const std::filesystem::path& file,
                   const TileIndex& contents,
                   const TileSetNote& note,
                   const Progress& progress) {
    constexpr std::size_t report_every = 1000;
    Database database{temporary, Database::Access::create, file};
    Transaction all{database, Transaction::Kind::write};
    database.run(tables);
    auto put_metadata = database.prepare("INSERT INTO metadata VALUES (?, ?)");
    for (const auto& [name, value] : metadata_of(note)) {
        put_metadata.run(name, value);
    }
    auto put_content = database.prepare("INSERT INTO images VALUES (?, ?)");
    auto put_tile = database.prepare("INSERT INTO map VALUES (?, ?, ?, ?)");
    std::size_t stored = 0, done = 0;
    for (const auto& [number, tile, content] : contents.entries()) {
        if (progress.stop.stop_requested()) {
            throw InputError{"stopped before the file was complete"};
        }
        if (content == stored) { // contents are numbered by first appearance
            put_content.run(std::int64_t{content} + 1, Blob{contents.bytes_of(content)});
            ++stored;
        }
        const auto row_from_south = (std::int64_t{1} << tile.zoom) - 1 - tile.y;
        put_tile.run(
            int{tile.zoom}, std::int64_t{tile.x}, row_from_south, std::int64_t{content} + 1);
        if (++done % report_every == 0) {
            progress(done, contents.entries().size());
        }
    }
    all.commit();
}

} // namespace macadam
