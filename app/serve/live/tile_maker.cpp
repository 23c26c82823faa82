#include "app/serve/live/tile_maker.hpp"

#include "app/tiles/tile_layers.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/tiles/tile_archive.hpp"

#include <string_view>
#include <utility>

namespace macadam {
namespace {

constexpr TilePlan plan{.min_zoom = TileSet::min_zoom, .max_zoom = TileSet::max_zoom};

} // namespace

TileMaker::Made::Made(const ClassTable& classes, const std::filesystem::path& beside)
    : source{beside}, pyramid{classes, plan, beside}, file{std::make_shared<TempFile>(beside)} {}

std::shared_ptr<const TileSet>
TileMaker::make(const StoreReader& store, const std::string& version, const Progress& progress) {
    const auto changed = read(store, progress);
    auto made = std::move(made_); // of no more use if this fails
    made_tiles_ = 0;
    const auto put = [&](const TileId& tile, std::string_view bytes) {
        const auto place = made->places.find(tile);
        if (place != made->places.end()) {
            made->bytes -= place->second.size;
            made->places.erase(place);
        }
        if (!bytes.empty()) {
            made->places.emplace(tile, made->file->append(bytes));
            made->bytes += bytes.size();
            ++made_tiles_;
        }
    };
    made->pyramid.update(made->source, changed, put, progress);
    made_ = std::move(made);
    compact();
    return std::make_shared<const TileSet>(version,
                                           layers_json(tile_layers(store, plan)),
                                           tile_bounds(store, made_->source.box),
                                           made_->file,
                                           made_->places);
}

/// Reads what has changed, or all, of one commit. \returns the tiles whose segments changed.
std::vector<TileId> TileMaker::read(const StoreReader& store, const Progress& progress) {
    const auto one_moment = store.hold();
    const auto moment = store.moment();
    if (auto made = std::move(made_)) {
        if (auto ranges = store.changed_since(made->moment)) {
            if (auto changed =
                    update_tile_source(store, *std::move(ranges), made->source, progress)) {
                made_ = std::move(made);
                made_->moment = moment;
                return *std::move(changed);
            }
        }
    }
    auto made = std::make_unique<Made>(*class_table(store.settings().class_table), beside_);
    read_tile_source(store, {}, made->source, progress);
    made->moment = moment;
    made_ = std::move(made);
    return made_->source.segments.tiles();
}

/// Leaves the file to the versions that use it, once most of it is of earlier ones.
void TileMaker::compact() {
    constexpr std::uint64_t free_bytes = std::uint64_t{64} << 20U;
    if (made_->file->size() <= 2 * made_->bytes + free_bytes) {
        return;
    }
    auto file = std::make_shared<TempFile>(beside_);
    auto places = made_->places;
    for (auto& [tile, place] : places) {
        place = file->append(made_->file->read(place));
    }
    made_->file = std::move(file);
    made_->places = std::move(places);
}

} // namespace macadam
