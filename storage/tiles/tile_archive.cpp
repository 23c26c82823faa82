#include "storage/tiles/tile_archive.hpp"

#include "estimator/common/error.hpp"
#include "mapping/geometry/hilbert_curve.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/atomic/atomic_file_set.hpp"
#include "storage/atomic/atomic_folder.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/text/json.hpp"
#include "storage/tiles/tile_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

namespace macadam {
namespace {

constexpr std::array<std::string_view, 2> suffixes{".mbtiles", ".pmtiles"};

const std::filesystem::path& expect_known_suffix(const std::filesystem::path& file) {
    const auto suffix = file.extension().string();
    if (std::ranges::find(suffixes, suffix) == suffixes.end()) {
        throw InputError{fmt::format("{}: suffix '{}', expected {} or a folder, as in tiles/",
                                     file.string(),
                                     suffix,
                                     fmt::join(suffixes, ", "))};
    }
    return file;
}

} // namespace

// ------------------------------------------------------------------------------------- contents

std::uint64_t tile_number(const TileId& tile) {
    const auto of_lower_zooms = ((std::uint64_t{1} << (2U * tile.zoom)) - 1) / 3;
    return of_lower_zooms + hilbert_distance(tile.x, tile.y, static_cast<unsigned>(tile.zoom));
}

std::uint32_t TileIndex::content_of(std::string_view bytes) {
    const auto hash = std::hash<std::string_view>{}(bytes);
    const auto [first, last] = by_hash_.equal_range(hash);
    const auto known = std::find_if(first, last, [&](const auto& candidate) {
        return size_of(candidate.second) == bytes.size() && bytes_of(candidate.second) == bytes;
    });
    if (known != last) {
        return known->second;
    }
    assert(places_.size() < std::numeric_limits<std::uint32_t>::max());
    const auto content = static_cast<std::uint32_t>(places_.size());
    places_.push_back(temp_file_.append(bytes));
    by_hash_.emplace(hash, content);
    return content;
}

void TileIndex::add(const TileId& tile, std::string_view bytes) {
    assert(!bytes.empty());
    entries_.push_back({tile_number(tile), tile, content_of(bytes)});
}

void TileIndex::sort() {
    by_hash_.clear();
    std::ranges::sort(entries_, {}, &TileEntry::number);
    assert(std::ranges::adjacent_find(entries_, {}, &TileEntry::number) == entries_.end());
    constexpr auto unseen = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> renumbered(places_.size(), unseen);
    std::vector<ByteRange> places;
    for (auto& entry : entries_) {
        auto& number = renumbered[entry.content];
        if (number == unseen) {
            number = static_cast<std::uint32_t>(places.size());
            places.push_back(places_[entry.content]);
        }
        entry.content = number;
    }
    places_ = std::move(places);
}

std::string layers_json(std::span<const TileLayer> layers) {
    std::vector<std::string> texts;
    for (const auto& layer : layers) {
        JsonObject fields;
        for (const auto& field : layer.fields) {
            fields.add(field.name, field.kind);
        }
        JsonObject object;
        object.add("id", layer.id)
            .add("description", layer.description)
            .add("minzoom", std::int64_t{layer.min_zoom})
            .add("maxzoom", std::int64_t{layer.max_zoom})
            .add("fields", JsonRaw{fields.text()});
        texts.push_back(object.text());
    }
    return texts.empty() ? std::string{} : json_array(texts);
}

TileSetCentre centre_of(const TileSetNote& note) {
    const auto& box = note.bounds;
    int zoom = note.max_zoom;
    const auto is_too_wide = [&](int at) {
        const auto first = tile_position({box.north_deg, box.west_deg}, at);
        const auto last = tile_position({box.south_deg, box.east_deg}, at);
        return std::max(last.x - first.x, last.y - first.y) > 2;
    };
    while (zoom > note.min_zoom && is_too_wide(zoom)) {
        --zoom;
    }
    return {{(box.south_deg + box.north_deg) / 2, (box.west_deg + box.east_deg) / 2}, zoom};
}

// -------------------------------------------------------------------------------------- archive

struct TileArchive::Impl {
    std::filesystem::path place;
    TileSetNote note;
    std::optional<AtomicFolder> folder; ///< alternatively
    std::optional<AtomicFile> file;     ///< alternatively
    std::optional<AtomicFileSet> database;
    TileIndex contents;

    Impl(const std::filesystem::path& path, TileSetNote said)
        : place{path}, note{std::move(said)}, contents{beside_tiles(path)} {
        if (is_tile_folder(place)) {
            folder.emplace(place);
        } else if (expect_known_suffix(place).extension() == ".pmtiles") {
            file.emplace(place);
        } else {
            database.emplace(place);
        }
    }

    void write(const Progress& progress) {
        if (folder) {
            write_tile_folder(folder->temporary(), place, contents, note, progress);
            folder->commit();
        } else if (file) {
            write_pmtiles(*file, contents, note, progress);
            file->commit();
        } else {
            write_mbtiles(database->main_file(), place, contents, note, progress);
            remove_leftovers_of(place);
            database->commit();
        }
    }
};

TileArchive::TileArchive(const std::filesystem::path& place, TileSetNote note)
    : impl_{std::make_unique<Impl>(place, std::move(note))} {
    assert(!is_empty(impl_->note.bounds));
    assert(impl_->note.min_zoom >= 0 && impl_->note.max_zoom <= max_zoom);
}

TileArchive::~TileArchive() = default;

void TileArchive::add(const TileId& tile, std::string_view bytes) {
    assert(tile.zoom >= impl_->note.min_zoom && tile.zoom <= impl_->note.max_zoom);
    impl_->contents.add(tile, bytes);
}

TileArchiveSize TileArchive::commit(const Progress& progress) {
    auto& contents = impl_->contents;
    if (contents.entries().empty()) {
        throw InputError{
            fmt::format("{}: there are no tiles, expected at least one", impl_->place.string())};
    }
    contents.sort();
    impl_->write(progress);
    return {contents.entries().size(), contents.count(), contents.bytes()};
}

bool is_tile_folder(const std::filesystem::path& place) {
    const bool is_known = std::ranges::find(suffixes, place.extension().string()) != suffixes.end();
    std::error_code none;
    return !place.has_filename() || (!is_known && std::filesystem::is_directory(place, none));
}

std::filesystem::path beside_tiles(const std::filesystem::path& place) {
    if (!is_tile_folder(place)) {
        return place;
    }
    // An existing folder may be on its own disk, and its parent may belong to another user.
    std::error_code none;
    const auto name = place.has_filename() ? place : place.parent_path();
    return std::filesystem::is_directory(name, none) ? name / "" : name;
}

std::span<const std::string_view> tile_archive_suffixes() {
    return suffixes;
}

} // namespace macadam
