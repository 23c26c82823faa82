#pragma once

#include "app/export/tile_pyramid.hpp"
#include "estimator/common/progress.hpp"
#include "render/scene/scene.hpp"
#include "storage/sqlite/lock_wait.hpp"

#include <filesystem>
#include <memory>

namespace macadam {

/// Which picture tiles to draw, and how.
struct PicturePlan {
    int min_zoom = 6;
    int max_zoom = 16;
    int tile_px = 256;    ///< 256 or 512
    std::size_t jobs = 1; ///< processes that draw
    GeoBox box;           ///< of the tiles; what lies around it is drawn on them too
    MapStyle style;       ///< with its classes
};

struct PictureCount {
    std::size_t tiles = 0;
    std::uint64_t largest_bytes = 0;
};

/// Processes that draw every tile of a plan's zooms that touches its box, with all roads of the
/// database, as PNG (render/tiles/tile_painter.hpp). Tiles are drawn in squares of 2048 px, by
/// processes that open the database each for itself: where somebody writes to it meanwhile, tiles
/// can be of different moments.
///
/// A tile is the same whatever the number of jobs. Processes that still draw at the end of this
/// object are killed.
class PicturePainters {
public:
    /// Starts to draw. To be made before this process has a second thread.
    ///
    /// \param store  its file; this process must not have it open
    /// \param plan   needed in this constructor alone
    /// \param patience  how each waits while another program keeps it from the database
    /// \throws InputError        if no process can be started
    /// \throws std::logic_error  if there is another thread
    PicturePainters(const std::filesystem::path& store,
                    const PicturePlan& plan,
                    LockWaitPolicy wait_policy = {});
    PicturePainters(const PicturePainters&) = delete;
    PicturePainters& operator=(const PicturePainters&) = delete;
    ~PicturePainters();

    /// Hands on each tile as it is drawn. To be called once.
    ///
    /// \throws InputError  if a stop is wanted, or a process failed, was killed, or has done
    /// nothing
    ///                     for 8 s
    PictureCount collect(const PutTile& put, const Progress& progress);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
