#include "storage/gzip.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <memory>
#include <new>
#include <vector>

namespace macadam {
namespace {

// Of 1 to 12.
constexpr int level_of_kept = 5; // 6 takes a third longer and saves hardly anything
constexpr int level_of_passing = 1;

struct Free {
    void operator()(libdeflate_compressor* compressor) const {
        libdeflate_free_compressor(compressor);
    }
};
using Compressor = std::unique_ptr<libdeflate_compressor, Free>;

Compressor new_compressor(int level) {
    Compressor compressor{libdeflate_alloc_compressor(level)};
    if (!compressor) {
        throw std::bad_alloc{};
    }
    return compressor;
}

} // namespace

std::string gzipped(std::string_view bytes, GzipEffort effort) {
    thread_local const auto of_kept = new_compressor(level_of_kept); // dear to make, small to keep
    thread_local const auto of_passing = new_compressor(level_of_passing);
    thread_local std::vector<char> room; // which only grows
    const auto& compressor = effort == GzipEffort::passing ? of_passing : of_kept;
    const auto most = libdeflate_gzip_compress_bound(compressor.get(), bytes.size());
    room.resize(std::max(room.size(), most));
    const auto size = libdeflate_gzip_compress(
        compressor.get(), bytes.data(), bytes.size(), room.data(), room.size());
    return {room.data(), size};
}

} // namespace macadam
