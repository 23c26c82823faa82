#include "render/map.hpp"

#include "estimator/common/error.hpp"

#include <fmt/core.h>
#include <png.h>

#include <cassert>
#include <string>

namespace macadam {
namespace {

// Maps are flat areas with thin lines: level 1 without row filters is quickest and hardly larger.
constexpr int quick = 1;

[[noreturn]] void fail(png_structp /*png*/, png_const_charp message) {
    throw InputError{fmt::format("cannot encode the picture: {}", message)};
}

void append(png_structp png, png_bytep data, std::size_t size) {
    auto& bytes = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
    bytes.insert(bytes.end(), data, data + size);
}

struct Writer {
    Writer() : png{png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr)} {
        info = png_create_info_struct(png);
    }
    ~Writer() { png_destroy_write_struct(&png, &info); }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    png_structp png;
    png_infop info;
};

} // namespace

std::vector<std::uint8_t> encode_png(const Image& image) {
    assert(image.rgb.size() == std::size_t(image.width) * std::size_t(image.height) * 3);

    std::vector<std::uint8_t> bytes;
    const Writer writer;
    png_set_write_fn(writer.png, &bytes, append, nullptr);
    png_set_IHDR(writer.png,
                 writer.info,
                 png_uint_32(image.width),
                 png_uint_32(image.height),
                 8,
                 PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(writer.png, quick);
    png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    png_write_info(writer.png, writer.info);
    for (int y = 0; y < image.height; ++y) {
        png_write_row(writer.png, image.rgb.data() + std::size_t(y) * image.width * 3);
    }
    png_write_end(writer.png, nullptr);
    return bytes;
}

} // namespace macadam
