#include "app/serve/live/picture_tiles.hpp"

#include "app/export/tile_square_painter.hpp"
#include "mapping/style/iri_class.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr int tile_px = 256;
constexpr std::uint32_t across = 4; // tiles; some 0.1 s for a square of a town

TileId square_of(const TileId& tile) {
    return {tile.zoom, tile.x / across * across, tile.y / across * across};
}

/// Painter of what an audience may see of a database now.
TileSquarePainter painter_of(const std::filesystem::path& file,
                             Audience audience,
                             bool left_hand,
                             const std::stop_token& stop) {
    auto store = StoreReader::open(file, {.stop = stop}, audience);
    MapStyle style;
    style.classes = class_table(store.settings().class_table);
    style.left_hand_traffic = left_hand;
    return TileSquarePainter{
        std::move(store), std::move(style), tile_px, tile_px * static_cast<int>(across)};
}

TileSquare whole_square(const TileId& first) {
    const auto last = (std::uint32_t{1} << first.zoom) - 1;
    return {first,
            {first.x,
             first.y,
             std::min(first.x + across - 1, last),
             std::min(first.y + across - 1, last)}};
}

} // namespace

/// Painter of a version, in the thread that draws.
struct PictureTiles::Painter {
    std::string version;
    TileSquarePainter painter;
};

PictureTiles::PictureTiles(std::filesystem::path file,
                           Audience audience,
                           const Console& console,
                           bool left_hand)
    : file_{std::move(file)}, audience_{audience}, console_{console},
      left_hand_{left_hand}, thread_{[this](const std::stop_token& stop) { work(stop); }} {}

PictureTiles::~PictureTiles() {
    request_stop();
}

void PictureTiles::request_stop() {
    stop_.request_stop();
    thread_.request_stop();
}

std::optional<PictureTiles::Tile> PictureTiles::tile(const std::string& version, const TileId& id) {
    const auto first = square_of(id);
    std::unique_lock lock{mutex_};
    forget_others(version);
    auto& place = squares_[first];
    if (!place) {
        if (asked_.size() >= max_squares) {
            squares_.erase(first);
            return std::nullopt;
        }
        place = std::make_shared<Square>();
        asked_.push_back(first);
        changed_.notify_all();
    }
    const auto square = place;
    if (!changed_.wait_for(lock, stop_.get_token(), max_time, [&] { return square->is_done; }) ||
        square->has_failed) {
        return std::nullopt;
    }
    if (square->use) {
        uses_.splice(uses_.begin(), uses_, *square->use);
    }
    const auto tile = square->tiles.find(id);
    return tile == square->tiles.end() ? Tile{} : tile->second;
}

void PictureTiles::forget_others(const std::string& version) {
    if (version == version_) {
        return;
    }
    version_ = version;
    for (auto& [first, square] : squares_) {
        square->use.reset();
    }
    for (const auto& first : asked_) { // nobody draws them any more
        auto& square = *squares_.at(first);
        square.has_failed = true;
        square.is_done = true;
    }
    changed_.notify_all();
    squares_.clear();
    asked_.clear();
    uses_.clear();
    bytes_ = 0;
}

/// Keeps a drawn square, and drops those that were not used for longest.
void PictureTiles::keep(const TileId& first, Square& square) {
    uses_.push_front(first);
    square.use = uses_.begin();
    bytes_ += square.bytes;
    while (bytes_ > max_bytes && uses_.size() > 1) {
        const auto oldest = squares_.find(uses_.back());
        bytes_ -= oldest->second->bytes;
        oldest->second->use.reset();
        squares_.erase(oldest);
        uses_.pop_back();
    }
}

void PictureTiles::draw(const TileId& first, const std::string& version, Square& square) {
    try {
        if (!painter_ || painter_->version != version) {
            painter_.reset();
            painter_ = std::make_unique<Painter>(
                Painter{version, painter_of(file_, audience_, left_hand_, stop_.get_token())});
        }
        auto& painter = painter_->painter;
        painter.draw(whole_square(first),
                     [&](const TileId& tile, const std::vector<std::uint8_t>& png) {
                         if (png != painter.empty()) {
                             square.tiles[tile] =
                                 std::make_shared<const std::string>(png.begin(), png.end());
                             square.bytes += png.size();
                         }
                     });
    } catch (const std::exception& error) {
        painter_.reset();
        square.has_failed = true;
        if (!stop_.stop_requested() && std::exchange(told_, error.what()) != error.what()) {
            console_.warn(fmt::format("picture tiles cannot be drawn: {}", error.what()));
        }
    }
}

void PictureTiles::work(const std::stop_token& stop) {
    while (true) {
        std::unique_lock lock{mutex_};
        if (!changed_.wait(lock, stop, [&] { return !asked_.empty(); }) || stop.stop_requested()) {
            break;
        }
        const auto first = asked_.front();
        asked_.pop_front();
        const auto version = version_;
        const auto square = squares_.at(first);
        lock.unlock();
        constexpr std::size_t entry_bytes = 512; // of a square without roads
        Square drawn{.bytes = entry_bytes};
        draw(first, version, drawn);
        lock.lock();
        const auto kept = squares_.find(first);
        const bool is_wanted = kept != squares_.end() && kept->second == square;
        *square = std::move(drawn);
        square->is_done = true;
        if (is_wanted && !square->has_failed) {
            keep(first, *square);
        } else if (is_wanted) { // the next request tries again
            squares_.erase(kept);
        }
        changed_.notify_all();
    }
    painter_.reset(); // its OpenGL context is of this thread
}

} // namespace macadam
