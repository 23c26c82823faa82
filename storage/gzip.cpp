#include "storage/gzip.hpp"

#include <libdeflate.h>

#include <memory>
#include <new>

namespace macadam {
namespace {

constexpr int level = 6; // of 1 to 12: a tile is made once and fetched often

struct Free {
    void operator()(libdeflate_compressor* compressor) const {
        libdeflate_free_compressor(compressor);
    }
};
using Compressor = std::unique_ptr<libdeflate_compressor, Free>;

Compressor new_compressor() {
    Compressor compressor{libdeflate_alloc_compressor(level)};
    if (!compressor) {
        throw std::bad_alloc{};
    }
    return compressor;
}

} // namespace

std::string gzipped(std::string_view bytes) {
    thread_local const auto compressor = new_compressor(); // dear to make, small to keep
    std::string packed(libdeflate_gzip_compress_bound(compressor.get(), bytes.size()), '\0');
    packed.resize(libdeflate_gzip_compress(
        compressor.get(), bytes.data(), bytes.size(), packed.data(), packed.size()));
    return packed;
}

} // namespace macadam
