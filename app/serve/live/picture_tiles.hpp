#pragma once

#include "app/cli/console.hpp"
#include "mapping/tiles/tile_grid.hpp"
#include "storage/store/records/publication.hpp"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

namespace macadam {

/// Picture tiles of one version of a database, drawn by a thread of its own when they are first
/// asked for, in squares of 4 x 4 tiles of 256 px; the latest are kept in memory.
class PictureTiles {
public:
    /// \param file       the database
    /// \param console    is told once why nothing can be drawn
    /// \param left_hand  traffic keeps left
    PictureTiles(std::filesystem::path file,
                 Audience audience,
                 const Console& console,
                 bool left_hand = false);
    ~PictureTiles();
    PictureTiles(const PictureTiles&) = delete;
    PictureTiles& operator=(const PictureTiles&) = delete;

    /// PNG; null for a tile without roads.
    using Tile = std::shared_ptr<const std::string>;

    /// Returns a tile of a version, once it is drawn. Thread-safe. Tiles of another version are
    /// forgotten; who waits for one gets `std::nullopt`.
    /// \returns `std::nullopt`  if it cannot be drawn, or not within max_time.
    std::optional<Tile> tile(const std::string& version, const TileId& id);

    /// Ends drawing, and those who wait.
    void request_stop();

    static constexpr std::chrono::seconds max_time{10};
    static constexpr std::size_t max_bytes = std::size_t{64} << 20U; ///< of kept tiles
    static constexpr std::size_t max_squares = 16;                   ///< that wait to be drawn

private:
    /// Square of tiles by its first one; its tiles are there once it is drawn.
    struct Square {
        std::map<TileId, Tile> tiles{};
        std::size_t bytes = 0;
        bool is_done = false;
        bool has_failed = false;
        std::optional<std::list<TileId>::iterator> use{}; ///< place in uses_ if it is kept
    };
    using SharedSquare = std::shared_ptr<Square>;

    void work(const std::stop_token& stop);
    void draw(const TileId& first, const std::string& version, Square& square);
    void forget_others(const std::string& version);
    void keep(const TileId& first, Square& square);

    std::filesystem::path file_;
    Audience audience_;
    const Console& console_;
    bool left_hand_;
    std::stop_source stop_; ///< of reading
    struct Painter;
    std::unique_ptr<Painter> painter_; ///< of the thread
    std::string told_;                 ///< the failure of which the console was told
    std::mutex mutex_;                 ///< guards the members below
    std::string version_;
    std::map<TileId, SharedSquare> squares_;
    std::deque<TileId> asked_;
    std::list<TileId> uses_; ///< drawn squares, latest use first
    std::size_t bytes_ = 0;
    std::condition_variable_any changed_;
    std::jthread thread_;
};

} // namespace macadam
