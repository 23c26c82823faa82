#include "storage/gzip.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <memory>
#include <new>
#include <vector>

namespace macadam {
namespace {

constexpr int level = 5; // of 1 to 12: 6 takes a third longer and saves hardly anything

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
    thread_local std::vector<char> room;                   // which only grows
    const auto most = libdeflate_gzip_compress_bound(compressor.get(), bytes.size());
    room.resize(std::max(room.size(), most));
    const auto size = libdeflate_gzip_compress(
        compressor.get(), bytes.data(), bytes.size(), room.data(), room.size());
    return {room.data(), size};
}

} // namespace macadam
