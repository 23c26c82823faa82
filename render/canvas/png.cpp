#include "render/canvas/png.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>
#include <png.h>

#include <cassert>
#include <cmath>
#include <string>
#include <utility>

namespace macadam {
namespace {

// Maps are flat areas with thin lines: level 1 without row filters is the fastest and hardly
// larger.
constexpr int quick = 1;

[[noreturn]] void fail(png_structp /*png*/, png_const_charp message) {
    throw InputError{fmt::format("cannot encode the picture: {}", message)};
}

void append(png_structp png, png_bytep data, std::size_t size) {
    auto& bytes = *static_cast<std::string*>(png_get_io_ptr(png));
    bytes.append(reinterpret_cast<const char*>(data), size); // NOLINT(*-cast)
}

} // namespace

struct PngWriter::Impl {
    Impl(int width, PutBytes put_bytes)
        : width_px{width}, put{std::move(put_bytes)},
          png{png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr)},
          info{png_create_info_struct(png)} {}
    ~Impl() { png_destroy_write_struct(&png, &info); }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    /// Passes the bytes on outside libpng's own call, through which the receiver's exceptions must
    /// not propagate.
    void hand_on() {
        if (!bytes.empty()) {
            put(bytes);
            bytes.clear();
        }
    }

    int width_px;
    PutBytes put;
    std::string bytes{};
    png_structp png;
    png_infop info;
};

PngWriter::PngWriter(const PictureSize& size, PutBytes put)
    : impl_{std::make_unique<Impl>(size.width_px, std::move(put))} {
    auto* const png = impl_->png;
    png_set_write_fn(png, &impl_->bytes, append, nullptr);
    png_set_IHDR(png,
                 impl_->info,
                 png_uint_32(size.width_px),
                 png_uint_32(size.height_px),
                 8,
                 PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (size.px_per_inch > 0) {
        const auto px_per_m = png_uint_32(std::lround(size.px_per_inch / 0.0254));
        png_set_pHYs(png, impl_->info, px_per_m, px_per_m, PNG_RESOLUTION_METER);
    }
    png_set_compression_level(png, quick);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    png_write_info(png, impl_->info);
}

PngWriter::~PngWriter() = default;

void PngWriter::add(std::span<const std::uint8_t> rgb) {
    const auto row_bytes = std::size_t(impl_->width_px) * 3;
    assert(rgb.size() % row_bytes == 0);
    for (; !rgb.empty(); rgb = rgb.subspan(row_bytes)) {
        png_write_row(impl_->png, rgb.data());
        impl_->hand_on();
    }
}

void PngWriter::finish() {
    png_write_end(impl_->png, nullptr);
    impl_->hand_on();
}

std::vector<std::uint8_t> encode_png(const Image& image) {
    assert(image.rgb.size() == std::size_t(image.width) * std::size_t(image.height) * 3);

    std::vector<std::uint8_t> bytes;
    PngWriter writer{{image.width, image.height}, [&](std::string_view more) {
                         bytes.insert(bytes.end(), more.begin(), more.end());
                     }};
    writer.add(image.rgb);
    writer.finish();
    return bytes;
}

} // namespace macadam
