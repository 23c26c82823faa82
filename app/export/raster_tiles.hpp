#pragma once

#include "app/tiles/tile_pyramid.hpp"
#include "estimator/common/progress.hpp"
#include "render/scene/scene.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"

#include <filesystem>
#include <memory>

namespace macadam {

/// Plan of the picture tiles to draw.
struct PicturePlan {
    int min_zoom = 6;
    int max_zoom = 16;
    int tile_px = 256;    ///< 256 or 512
    std::size_t jobs = 1; ///< number of drawing processes
    GeoBox box;           ///< extent of the tiles; roads around it are drawn, too
    MapStyle style;       ///< includes the classes
};

struct PictureCount {
    std::size_t tiles = 0;
    std::uint64_t largest_bytes = 0;
};

/// Pool of processes that draw every tile in the zooms and box of a plan, with all roads of the
/// database, as PNG (render/tiles/tile_painter.hpp). Tiles are drawn in squares of 2048 px. Each
/// process opens the database itself: if it is written to meanwhile, tiles can show different
/// versions.
///
/// Tiles do not depend on the number of jobs. The destructor kills processes that are still
/// drawing.
class PicturePainters {
public:
    /// Starts the processes. Call before this process has a second thread.
    ///
    /// \param store            file of the database; must not be open in this process
    /// \param plan             used by this constructor only
    /// \param wait_policy      wait of each process while another program locks the database
    /// \throws InputError        if no process can be started
    /// \throws std::logic_error  if there is another thread
    PicturePainters(const std::filesystem::path& store,
                    const PicturePlan& plan,
                    LockWaitPolicy wait_policy = {});
    PicturePainters(const PicturePainters&) = delete;
    PicturePainters& operator=(const PicturePainters&) = delete;
    ~PicturePainters();

    /// Passes on each tile as it is drawn. Call once.
    ///
    /// \throws InputError  on a stop request, or if a process fails, is killed or is idle for 8 s
    PictureCount collect(const PutTile& put, const Progress& progress);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
