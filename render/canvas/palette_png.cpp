#include "render/canvas/palette_png.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <span>
#include <unordered_map>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t max_colours = 256;

std::uint32_t colour_at(const Image& image, std::size_t pixel) {
    const auto* const rgb = image.rgb.data() + 3 * pixel;
    return std::uint32_t(rgb[0]) << 16U | std::uint32_t(rgb[1]) << 8U | rgb[2];
}

int squared_distance(std::uint32_t a, std::uint32_t b) {
    int sum = 0;
    for (const unsigned shift : {16U, 8U, 0U}) {
        const int difference = int(a >> shift & 255U) - int(b >> shift & 255U);
        sum += difference * difference;
    }
    return sum;
}

/// Returns the colours of a picture, the most frequent first.
std::vector<std::uint32_t> colours_of(const Image& image) {
    std::unordered_map<std::uint32_t, std::size_t> pixels;
    for (std::size_t i = 0; i < image.rgb.size() / 3; ++i) {
        ++pixels[colour_at(image, i)];
    }
    std::vector<std::pair<std::size_t, std::uint32_t>> ordered;
    ordered.reserve(pixels.size());
    for (const auto& [colour, count] : pixels) {
        ordered.emplace_back(count, colour);
    }
    std::ranges::sort(ordered, std::ranges::greater{});
    std::vector<std::uint32_t> colours;
    colours.reserve(ordered.size());
    for (const auto& [count, colour] : ordered) {
        colours.push_back(colour);
    }
    return colours;
}

/// Returns the most frequent colours, those of areas and of their transitions, and of the others
/// the ones that are farther than a distance from all before them, at most one more than a palette
/// has.
std::vector<std::uint32_t> apart(const std::vector<std::uint32_t>& colours, int squared) {
    constexpr std::size_t exact = max_colours / 2;
    const auto first = colours.begin() + std::ptrdiff_t(std::min(exact, colours.size()));
    std::vector<std::uint32_t> palette{colours.begin(), first};
    for (const auto colour : std::span{first, colours.end()}) {
        const auto is_near = [&](std::uint32_t other) {
            return squared_distance(colour, other) <= squared;
        };
        if (std::ranges::none_of(palette, is_near)) {
            palette.push_back(colour);
            if (palette.size() > max_colours) {
                break;
            }
        }
    }
    return palette;
}

std::vector<std::uint32_t> palette_of(const std::vector<std::uint32_t>& colours) {
    auto palette = apart(colours, 0);
    for (int levels = 2; palette.size() > max_colours; ++levels) {
        palette = apart(colours, levels * levels);
    }
    return palette;
}

/// Returns the index of the nearest colour of a palette for each colour.
std::unordered_map<std::uint32_t, std::uint8_t>
nearest_of(const std::vector<std::uint32_t>& colours, const std::vector<std::uint32_t>& palette) {
    std::unordered_map<std::uint32_t, std::uint8_t> nearest;
    for (const auto colour : colours) {
        const auto found = std::ranges::min_element(
            palette, {}, [colour](auto other) { return squared_distance(other, colour); });
        nearest.emplace(colour, static_cast<std::uint8_t>(found - palette.begin()));
    }
    return nearest;
}

} // namespace

std::vector<std::uint8_t> encode_palette_png(const Image& image) {
    assert(image.rgb.size() == std::size_t(image.width) * std::size_t(image.height) * 3);
    const auto colours = colours_of(image);
    const auto palette = palette_of(colours);
    const auto nearest = nearest_of(colours, palette);
    std::vector<std::uint8_t> pixels(image.rgb.size() / 3);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = nearest.at(colour_at(image, i));
    }
    std::array<std::uint8_t, 3 * max_colours> map{};
    for (std::size_t i = 0; i < palette.size(); ++i) {
        map[3 * i] = static_cast<std::uint8_t>(palette[i] >> 16U);
        map[3 * i + 1] = static_cast<std::uint8_t>(palette[i] >> 8U);
        map[3 * i + 2] = static_cast<std::uint8_t>(palette[i]);
    }
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = png_uint_32(image.width);
    png.height = png_uint_32(image.height);
    png.format = PNG_FORMAT_RGB_COLORMAP;
    png.colormap_entries = png_uint_32(palette.size());
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::vector<std::uint8_t> bytes(size);
    if (png_image_write_to_memory(&png, bytes.data(), &size, 0, pixels.data(), 0, map.data()) ==
        0) {
        throw InputError{fmt::format("cannot encode the picture: {}", png.message)};
    }
    bytes.resize(size);
    return bytes;
}

} // namespace macadam
