#include "render/tiles/tile_png.hpp"

#include "render/background/background_painter.hpp"
#include "render/scene/colour.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <new>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

// For libdeflate: with thin lines on a flat ground, level 6 saves a tenth and takes twice the time.
constexpr int compression = 4;
constexpr std::size_t max_colours = 255; // index 0 of the table below means "not yet looked up"

struct Channels {
    int red, green, blue;
};

Channels channels(std::uint32_t rgb) {
    return {int(rgb >> 16 & 255U), int(rgb >> 8 & 255U), int(rgb & 255U)};
}

int distance(std::uint32_t a, std::uint32_t b) {
    const auto [red_a, green_a, blue_a] = channels(a);
    const auto [red_b, green_b, blue_b] = channels(b);
    const int red = red_a - red_b;
    const int green = green_a - green_b;
    const int blue = blue_a - blue_b;
    return red * red + green * green + blue * blue;
}

std::uint32_t mixed(std::uint32_t a, std::uint32_t b, double share) {
    const auto part = [share](int from, int to) {
        return std::uint32_t(std::lround(std::lerp(double(from), double(to), share)));
    };
    const auto [red_a, green_a, blue_a] = channels(a);
    const auto [red_b, green_b, blue_b] = channels(b);
    return part(red_a, red_b) << 16 | part(green_a, green_b) << 8 | part(blue_a, blue_b);
}

using Sides = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

void append_steps(std::vector<std::uint32_t>& colours, const Sides& sides, std::size_t steps) {
    for (const auto& [from, to] : sides) {
        for (std::size_t i = 1; i <= steps; ++i) {
            colours.push_back(mixed(from, to, double(i) / double(steps + 1)));
        }
    }
}

/// Appends the colours of a background, and steps to those beside and on it. They are near the
/// ground's, so that few steps are enough.
void append_background(std::vector<std::uint32_t>& colours,
                       const Palette& other,
                       MapStyle::Theme theme) {
    constexpr std::size_t steps = 3;
    Sides sides;
    for (std::size_t i = 0; i < background_kinds; ++i) {
        const auto colour = background_colour(static_cast<BackgroundKind>(i), theme);
        if (std::ranges::find(colours, colour) != colours.end()) {
            continue;
        }
        colours.push_back(colour);
        for (const auto beside : {other.ground, other.casing, other.ink}) {
            sides.emplace_back(colour, beside);
        }
    }
    append_steps(colours, sides, steps);
}

/// Returns the colours of a style, then steps between those that are adjacent on a tile.
std::vector<std::uint32_t> palette_of(const MapStyle& style, bool has_background) {
    const auto other = palette(style);
    const auto ramp = class_colours(style, classes_of(style).classes.size());

    std::vector<std::uint32_t> colours{
        other.ground, other.casing, other.unmeasured, other.few_passes, other.ink, other.quiet_ink};
    if (has_background) {
        append_background(colours, other, style.theme);
    }
    Sides sides{{other.ground, other.casing},
                {other.ground, other.unmeasured},
                {other.casing, other.unmeasured},
                {other.casing, other.few_passes},
                {other.ground, other.quiet_ink},
                {other.ground, other.ink}};
    // Any two classes can meet, but with many classes there is room for the steps of neighbours
    // only.
    const std::size_t apart = ramp.size() <= 5 ? ramp.size() : 1;
    for (std::size_t i = 0; i < ramp.size(); ++i) {
        colours.push_back(ramp[i]);
        sides.emplace_back(other.casing, ramp[i]);
        sides.emplace_back(other.ground, ramp[i]);
        for (std::size_t k = i - std::min(i, apart); k < i; ++k) {
            sides.emplace_back(ramp[k], ramp[i]);
        }
    }
    append_steps(colours, sides, (max_colours - colours.size()) / sides.size());
    std::ranges::sort(colours);
    const auto twice = std::ranges::unique(colours);
    colours.erase(twice.begin(), twice.end());
    return colours;
}

using Bytes = std::vector<std::uint8_t>;

void put_number(Bytes& bytes, std::uint32_t number) {
    for (const unsigned shift : {24U, 16U, 8U, 0U}) {
        bytes.push_back(std::uint8_t(number >> shift));
    }
}

/// Source: ISO/IEC 15948:2004 (PNG), 5.3: length, type, data, CRC of type and data.
void put_chunk(Bytes& bytes, std::string_view type, std::span<const std::uint8_t> data) {
    put_number(bytes, std::uint32_t(data.size()));
    const auto begin = bytes.size();
    bytes.insert(bytes.end(), type.begin(), type.end());
    bytes.insert(bytes.end(), data.begin(), data.end());
    put_number(bytes, libdeflate_crc32(0, bytes.data() + begin, bytes.size() - begin));
}

struct Free {
    void operator()(libdeflate_compressor* compressor) const {
        libdeflate_free_compressor(compressor);
    }
};

/// Nearest colour of a palette for each of 2^24, computed on first use. Unused pages of the table
/// take no memory.
class NearestColour {
public:
    explicit NearestColour(std::vector<std::uint32_t> palette)
        : palette_{std::move(palette)}, known_{static_cast<std::uint8_t*>(
                                            std::calloc(std::size_t{1} << 24, 1))} {
        if (known_ == nullptr) {
            throw std::bad_alloc{};
        }
    }

    std::uint8_t index(std::uint32_t rgb) {
        auto& known = known_.get()[rgb];
        if (known == 0) {
            const auto nearest = std::ranges::min_element(
                palette_, {}, [rgb](std::uint32_t one) { return distance(one, rgb); });
            known = std::uint8_t(nearest - palette_.begin() + 1);
        }
        return std::uint8_t(known - 1);
    }

    std::span<const std::uint32_t> palette() const { return palette_; }

private:
    struct Release {
        void operator()(std::uint8_t* bytes) const { std::free(bytes); }
    };
    std::vector<std::uint32_t> palette_;
    std::unique_ptr<std::uint8_t, Release> known_; ///< index + 1, or 0
};

} // namespace

struct TilePng::Impl {
    Impl(const MapStyle& style, bool has_background)
        : nearest{palette_of(style, has_background)}, ground{macadam::palette(style).ground},
          compressor{libdeflate_alloc_compressor(compression)} {
        if (compressor == nullptr) {
            throw std::bad_alloc{};
        }
    }

    Bytes file(int side_px);
    Bytes used_colours(int side_px);

    NearestColour nearest;
    std::uint32_t ground;
    std::unique_ptr<libdeflate_compressor, Free> compressor;
    Bytes rows; ///< of the tile: for each, its filter 0 and one index per pixel
    Bytes stream;
};

/// Returns the palette colours that the rows use, and renumbers the rows. The first byte of a row
/// is its filter.
Bytes TilePng::Impl::used_colours(int side_px) {
    const auto row = std::size_t(side_px) + 1;
    const auto each_row = [&](const auto& use) {
        for (std::size_t first = 0; first < rows.size(); first += row) {
            use(std::span{rows}.subspan(first + 1, row - 1));
        }
    };
    std::array<bool, 256> used{};
    each_row([&](std::span<const std::uint8_t> pixels) {
        for (const auto pixel : pixels) {
            used[pixel] = true;
        }
    });
    std::array<std::uint8_t, 256> number{};
    Bytes colours;
    for (std::size_t i = 0; i < nearest.palette().size(); ++i) {
        if (used[i]) {
            const auto rgb = nearest.palette()[i];
            number[i] = std::uint8_t(colours.size() / 3);
            colours.insert(colours.end(),
                           {std::uint8_t(rgb >> 16), std::uint8_t(rgb >> 8), std::uint8_t(rgb)});
        }
    }
    each_row([&](std::span<std::uint8_t> pixels) {
        for (auto& pixel : pixels) {
            pixel = number[pixel];
        }
    });
    return colours;
}

Bytes TilePng::Impl::file(int side_px) {
    const auto colours = used_colours(side_px);
    stream.resize(libdeflate_zlib_compress_bound(compressor.get(), rows.size()));
    stream.resize(libdeflate_zlib_compress(
        compressor.get(), rows.data(), rows.size(), stream.data(), stream.size()));
    constexpr std::array<std::uint8_t, 8> signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    Bytes bytes{signature.begin(), signature.end()};
    Bytes head;
    put_number(head, std::uint32_t(side_px));
    put_number(head, std::uint32_t(side_px));
    // Eight bits per pixel, palette; the only compression and filter methods; no interlacing.
    head.insert(head.end(), {8, 3, 0, 0, 0});
    put_chunk(bytes, "IHDR", head);
    put_chunk(bytes, "PLTE", colours);
    put_chunk(bytes, "IDAT", stream);
    put_chunk(bytes, "IEND", {});
    return bytes;
}

TilePng::TilePng(const MapStyle& style, bool has_background)
    : impl_{std::make_unique<Impl>(style, has_background)} {}
TilePng::~TilePng() = default;
TilePng::TilePng(TilePng&&) noexcept = default;
TilePng& TilePng::operator=(TilePng&&) noexcept = default;

Bytes TilePng::encode(const Image& image, const PictureCut& cut) {
    assert(cut.left_px >= 0 && cut.top_px >= 0 && cut.left_px + cut.side_px <= image.width &&
           cut.top_px + cut.side_px <= image.height);
    auto& rows = impl_->rows;
    rows.resize((std::size_t(cut.side_px) + 1) * std::size_t(cut.side_px));
    auto* pixel = rows.data();
    std::uint32_t last = impl_->ground;
    std::uint8_t index = impl_->nearest.index(last);
    for (int y = cut.top_px; y < cut.top_px + cut.side_px; ++y) {
        *pixel++ = 0; // no filter: differences of palette indices are meaningless
        const auto* rgb =
            image.rgb.data() + (std::size_t(y) * image.width + std::size_t(cut.left_px)) * 3;
        for (int x = 0; x < cut.side_px; ++x, rgb += 3) {
            const auto colour =
                std::uint32_t(rgb[0]) << 16 | std::uint32_t(rgb[1]) << 8 | std::uint32_t(rgb[2]);
            if (colour != last) {
                last = colour;
                index = impl_->nearest.index(colour);
            }
            *pixel++ = index;
        }
    }
    return impl_->file(cut.side_px);
}

Bytes TilePng::empty(int side_px) {
    const auto row = std::size_t(side_px) + 1;
    impl_->rows.assign(row * std::size_t(side_px), impl_->nearest.index(impl_->ground));
    for (std::size_t i = 0; i < impl_->rows.size(); i += row) {
        impl_->rows[i] = 0;
    }
    return impl_->file(side_px);
}

std::span<const std::uint32_t> TilePng::palette() const {
    return impl_->nearest.palette();
}

std::uint32_t TilePng::shown(std::uint32_t rgb) {
    return impl_->nearest.palette()[impl_->nearest.index(rgb)];
}

} // namespace macadam
