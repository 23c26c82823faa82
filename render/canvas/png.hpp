#pragma once

#include "render/scene/scene.hpp"

#include <functional>
#include <memory>
#include <span>
#include <string_view>

namespace macadam {

/// Writes a PNG file row by row, for pictures of any size.
class PngWriter {
public:
    using PutBytes = std::function<void(std::string_view bytes)>;

    PngWriter(const PictureSize& size, PutBytes put);
    ~PngWriter();

    /// Appends some whole rows.
    void add(std::span<const std::uint8_t> rgb);

    /// Ends the file after the last row.
    void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
