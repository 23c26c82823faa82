#pragma once

#include "render/scene/scene.hpp"

#include <functional>
#include <memory>
#include <span>
#include <string_view>

namespace macadam {

/// A PNG file, row by row, as large as the picture may be.
class PngWriter {
public:
    using PutBytes = std::function<void(std::string_view bytes)>;

    PngWriter(int width_px, int height_px, PutBytes put);
    ~PngWriter();

    /// Some whole rows, the next after those before.
    void add(std::span<const std::uint8_t> rgb);

    /// After the last row.
    void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
