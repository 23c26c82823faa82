#include "storage/networks/osm_blobs.hpp"

#include "estimator/common/error.hpp"
#include "storage/networks/osm_objects.hpp"
#include "storage/networks/pbf_fields.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <utility>

namespace macadam {
namespace {

// Source of tags, types and limits: OSM wiki, page PBF Format; fileformat.proto.

constexpr std::uint32_t max_header_bytes = 64 << 10;
constexpr std::uint32_t max_blob_bytes = 32 << 20;

enum class BlobHeader : protozero::pbf_tag_type { type = 1, datasize = 3 };
enum class BlobField : protozero::pbf_tag_type { raw = 1, raw_size = 2, zlib_data = 3 };

[[noreturn]] void fail(const std::string& what) {
    throw InputError{what};
}

std::pair<std::string, std::size_t> header_in(std::string_view bytes) {
    auto header = pbf_message<BlobHeader>(bytes);
    std::string type;
    std::int32_t size = 0;
    while (header.next()) {
        switch (header.tag_and_type()) {
        case bytes_field(BlobHeader::type):
            type = header.get_string();
            break;
        case number_field(BlobHeader::datasize):
            size = header.get_int32();
            break;
        default:
            header.skip();
        }
    }
    if (size <= 0 || static_cast<std::uint32_t>(size) > max_blob_bytes) {
        fail(fmt::format("a blob of {} bytes, expected 1 to {}", size, max_blob_bytes));
    }
    return {std::move(type), static_cast<std::size_t>(size)};
}

} // namespace

OsmBlobs::OsmBlobs(const std::filesystem::path& file)
    : bytes_{file_bytes(file)}, file_bytes_{std::filesystem::file_size(file)} {}

std::optional<OsmBlobs::Blob> OsmBlobs::next() {
    std::array<char, 4> length{};
    if (!fill(length, true)) {
        return std::nullopt;
    }
    std::uint32_t header_bytes = 0;
    for (const char byte : length) { // big endian
        header_bytes = header_bytes << 8U | static_cast<unsigned char>(byte);
    }
    if (header_bytes > max_header_bytes) {
        fail(fmt::format(
            "a blob's header of {} bytes, expected at most {}", header_bytes, max_header_bytes));
    }
    packed_.resize(header_bytes);
    fill(packed_, false);
    auto [type, size] = header_in(packed_);
    packed_.resize(size);
    fill(packed_, false);
    return Blob{std::move(type), unpacked()};
}

/// \returns false at the end of the file, if that is allowed here.
bool OsmBlobs::fill(std::span<char> into, bool may_end) {
    std::size_t have = 0;
    while (have < into.size()) {
        const auto more = bytes_->read(into.subspan(have));
        if (more == 0 && have == 0 && may_end) {
            return false;
        }
        if (more == 0) {
            fail("it is truncated");
        }
        have += more;
    }
    return true;
}

std::string_view OsmBlobs::unpacked() {
    auto blob = pbf_message<BlobField>(packed_);
    std::optional<std::string_view> raw;
    std::optional<std::string_view> zlib;
    std::int32_t raw_bytes = 0;
    while (blob.next()) {
        switch (blob.tag_and_type()) {
        case bytes_field(BlobField::raw):
            raw = bytes_of(blob.get_view());
            break;
        case number_field(BlobField::raw_size):
            raw_bytes = blob.get_int32();
            break;
        case bytes_field(BlobField::zlib_data):
            zlib = bytes_of(blob.get_view());
            break;
        default:
            fail("a blob is packed by another method than zlib");
        }
    }
    if (!raw && !zlib) {
        fail("a blob without data");
    }
    const auto content = raw ? *raw : inflated(*zlib, raw_bytes);
    unpacked_bytes_ += content.size();
    if (unpacked_bytes_ > free_pbf_bytes + max_pbf_expansion * file_bytes_) {
        fail(fmt::format("it unpacks to more than {} times its size, which no map does",
                         max_pbf_expansion));
    }
    return content;
}

std::string_view OsmBlobs::inflated(std::string_view zlib, std::int32_t raw_bytes) {
    if (raw_bytes <= 0 || static_cast<std::uint32_t>(raw_bytes) > max_blob_bytes) {
        fail(fmt::format(
            "a blob that unpacks to {} bytes, expected 1 to {}", raw_bytes, max_blob_bytes));
    }
    inflated_.resize(static_cast<std::size_t>(raw_bytes));
    auto size = static_cast<uLongf>(raw_bytes);
    const auto result = ::uncompress(reinterpret_cast<Bytef*>(inflated_.data()),
                                     &size,
                                     reinterpret_cast<const Bytef*>(zlib.data()),
                                     static_cast<uLong>(zlib.size()));
    if (result != Z_OK || size != static_cast<uLongf>(raw_bytes)) {
        fail("a blob's zlib data is damaged");
    }
    return inflated_;
}

} // namespace macadam
