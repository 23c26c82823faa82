#pragma once

#include "estimator/common/geo.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

class OGRCoordinateTransformation;
class OGRLayer;
class OGRSimpleCurve;

namespace macadam {

/// Converts the points of a layer to WGS 84. A layer without a coordinate system is taken for
/// degrees.
class LayerCoordinates {
public:
    /// \param file   for messages
    /// \param bytes  size of the layer's files, which limits its points: some formats store an arc
    ///               in a few bytes and expand it to any number of points
    /// \throws InputError  for a coordinate system that cannot be converted.
    LayerCoordinates(std::string file, OGRLayer& layer, std::uintmax_t bytes);

    /// \throws InputError  for points that are not on the globe, and if the layer has had more
    ///                     points than its bytes can hold.
    std::vector<GeoPoint> places_of(const OGRSimpleCurve& line);

    /// \throws InputError  "FILE: layer 'NAME': WHAT"
    [[noreturn]] void fail(const std::string& what) const;

private:
    struct Free {
        void operator()(OGRCoordinateTransformation* transformation) const;
    };

    std::string file_;
    OGRLayer& layer_;
    std::uintmax_t points_left_;
    std::unique_ptr<OGRCoordinateTransformation, Free> to_wgs84_;
};

} // namespace macadam
