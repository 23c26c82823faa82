#include "compressed.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <zlib.h>
#include <zstd.h>

#include <cstddef>

namespace macadam::testing {

std::string gzipped(std::string_view text) {
    constexpr int gzip = 15 + 16;
    z_stream state{};
    deflateInit2(&state, Z_BEST_SPEED, Z_DEFLATED, gzip, 8, Z_DEFAULT_STRATEGY);
    std::string result(deflateBound(&state, text.size()), '\0');
    state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data())); // NOLINT
    state.avail_in = static_cast<uInt>(text.size());
    state.next_out = reinterpret_cast<Bytef*>(result.data()); // NOLINT
    state.avail_out = static_cast<uInt>(result.size());
    deflate(&state, Z_FINISH);
    result.resize(state.total_out);
    deflateEnd(&state);
    return result;
}

std::string zstd_compressed(std::string_view text) {
    std::string result(ZSTD_compressBound(text.size()), '\0');
    result.resize(ZSTD_compress(result.data(), result.size(), text.data(), text.size(), 1));
    return result;
}

std::string archive_of(const std::string& format,
                       const std::vector<std::pair<std::string, std::string>>& members) {
    auto* const writer = archive_write_new();
    if (format == "zip") {
        archive_write_set_format_zip(writer);
    } else {
        archive_write_set_format_pax_restricted(writer);
    }
    if (format == "tar.gz") {
        archive_write_add_filter_gzip(writer);
    } else if (format == "tar.zst") {
        archive_write_add_filter_zstd(writer);
    }
    std::string result(1 << 20, '\0');
    std::size_t used = 0;
    archive_write_open_memory(writer, result.data(), result.size(), &used);
    for (const auto& [name, content] : members) {
        auto* const entry = archive_entry_new();
        archive_entry_set_pathname(entry, name.c_str());
        archive_entry_set_filetype(entry, AE_IFREG);
        archive_entry_set_perm(entry, 0644);
        archive_entry_set_size(entry, static_cast<la_int64_t>(content.size()));
        archive_write_header(writer, entry);
        archive_write_data(writer, content.data(), content.size());
        archive_entry_free(entry);
    }
    archive_write_close(writer);
    archive_write_free(writer);
    result.resize(used);
    return result;
}

} // namespace macadam::testing
