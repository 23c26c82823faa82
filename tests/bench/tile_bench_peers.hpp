#pragma once

#include "render/scene/scene.hpp"

#include <memory>
#include <string>
#include <vector>

namespace macadam::bench {

/// Mapnik 3.1 on a layer of a GeoPackage, by its OGR plugin: each class in its colour, casing below
/// core, round joins; both directions lie on each other, which is less work than ours.
class MapnikTiles {
public:
    MapnikTiles(const std::string& file,
                const std::string& layer,
                int tile_px,
                double core_px,
                double casing_px);
    ~MapnikTiles();

    void draw(const GeoBox& box);

    /// What was drawn, as Mapnik's smallest and quickest form of it: 256 colours, zlib level 1.
    std::string png8() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The same lines, cased, with round joins and caps, on top of each other.
void draw_in_cairo(const std::vector<MapLine>& lines,
                   const GeoBox& box,
                   int side_px,
                   double core_px,
                   double casing_px);

} // namespace macadam::bench
