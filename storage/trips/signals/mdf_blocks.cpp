#include "storage/trips/signals/mdf_blocks.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

namespace macadam {

static_assert(std::endian::native == std::endian::little, "MDF numbers are copied as they are");

namespace {

constexpr std::size_t header_size = 24;
constexpr std::size_t max_chain = 1'000'000;
constexpr std::size_t max_text = 1 << 10;

template <typename Number>
Number number_at(std::string_view bytes, std::size_t offset) {
    Number number{};
    if (offset <= bytes.size() && bytes.size() - offset >= sizeof number) {
        std::memcpy(&number, bytes.data() + offset, sizeof number);
    }
    return number;
}

} // namespace

std::uint64_t MdfBlock::link(std::size_t i) const {
    return number_at<std::uint64_t>(links, 8 * i);
}

template <typename Number>
Number MdfBlock::number(std::size_t offset) const {
    return number_at<Number>(data, offset);
}

template std::uint8_t MdfBlock::number(std::size_t) const;
template std::uint16_t MdfBlock::number(std::size_t) const;
template std::uint32_t MdfBlock::number(std::size_t) const;
template std::uint64_t MdfBlock::number(std::size_t) const;
template double MdfBlock::number(std::size_t) const;

MdfBlocks::MdfBlocks(std::string_view bytes, std::string name)
    : bytes_{bytes}, name_{std::move(name)} {
    if (bytes.starts_with("UnFinMF ")) {
        throw InputError{name_ + ": is an MDF file that was not finalised, as its logger was cut "
                                 "off; expected one that the logger's software has finalised"};
    }
    const auto version = number_at<std::uint16_t>(bytes, 28);
    if (!bytes.starts_with("MDF     ") || version < 400 || version >= 500) {
        throw InputError{fmt::format(
            "{}: {}, expected an ASAM MDF file of version 4",
            name_,
            bytes.starts_with("MDF     ")
                ? fmt::format("is MDF of version {}.{:02}", version / 100, version % 100)
                : "begins with " + in_quotes(bytes.substr(0, 16)))};
    }
}

void MdfBlocks::refuse(std::uint64_t at, std::string_view words) const {
    throw InputError{fmt::format("{}: byte {}: {}", name_, at, words)};
}

MdfBlock MdfBlocks::block(std::uint64_t at, std::string_view ids) const {
    if (at > bytes_.size() || bytes_.size() - at < header_size) {
        refuse(at, "a link leads beyond the end of the file, which may be truncated");
    }
    const auto bytes = bytes_.substr(at);
    const auto id = bytes.substr(2, 2);
    bool is_expected = false;
    for (std::size_t i = 0; i < ids.size(); i += 2) {
        is_expected = is_expected || id == ids.substr(i, 2);
    }
    if (!bytes.starts_with("##") || !is_expected) {
        refuse(at, fmt::format("a block {}, expected ##{}", in_quotes(bytes.substr(0, 4)), ids));
    }
    const auto length = number_at<std::uint64_t>(bytes, 8);
    const auto links = number_at<std::uint64_t>(bytes, 16);
    if (length < header_size || length > bytes.size() || links > (length - header_size) / 8) {
        refuse(at,
               fmt::format("a block of {} bytes with {} links, of {} bytes to the end of the file",
                           length,
                           links,
                           bytes.size()));
    }
    return {.at = at,
            .id = id,
            .links = bytes.substr(header_size, 8 * links),
            .data = bytes.substr(header_size + 8 * links, length - header_size - 8 * links)};
}

std::vector<MdfBlock> MdfBlocks::chain(std::uint64_t first, std::string_view id) const {
    std::vector<MdfBlock> blocks;
    for (auto at = first; at != 0; at = blocks.back().link(0)) {
        if (blocks.size() >= max_chain) {
            refuse(at, fmt::format("the list of blocks ##{} is longer than {}", id, max_chain));
        }
        take_once(at);
        blocks.push_back(block(at, id));
    }
    return blocks;
}

/// Refuses a block that was taken before: lists in a circle, or one that many share, would make a
/// small file endless.
void MdfBlocks::take_once(std::uint64_t at) const {
    if (!taken_.insert(at).second) {
        refuse(at, "a block is listed twice, or its list goes in a circle");
    }
}

std::string MdfBlocks::text(std::uint64_t at) const {
    if (at == 0) {
        return "";
    }
    const auto found = block(at, "TXMD");
    auto text = found.data.substr(0, std::min(found.data.find('\0'), max_text));
    if (found.id == "MD") {
        const auto begin = text.find("<TX>");
        const auto end = text.find("</TX>");
        text = begin == std::string_view::npos || end == std::string_view::npos || end < begin + 4
                   ? std::string_view{}
                   : text.substr(begin + 4, end - begin - 4);
    }
    return std::string{trimmed(text)};
}

void MdfBlocks::each_data(std::uint64_t at,
                          const std::function<void(std::string_view)>& take) const {
    if (at == 0) {
        return;
    }
    const auto first = block(at, "DTSDDZDLHL");
    if (first.id == "DT" || first.id == "SD") {
        take_once(at);
        take(first.data);
    } else if (first.id == "DZ") {
        take_once(at);
        take(unzipped(first));
    } else if (first.id == "HL") {
        if (first.link(0) != 0) {
            each_data(block(first.link(0), "DL").at, take);
        }
    } else {
        for (const auto& list : chain(at, "DL")) {
            for (std::size_t i = 1; i < list.link_count(); ++i) {
                if (list.link(i) != 0) {
                    const auto part = block(list.link(i), "DTSDDZ");
                    take_once(part.at);
                    if (part.id == "DZ") {
                        take(unzipped(part));
                    } else {
                        take(part.data);
                    }
                }
            }
        }
    }
}

/// Inflates a DZ block; with zip type 1 its bytes were transposed before, as a matrix of so many
/// columns.
std::string MdfBlocks::unzipped(const MdfBlock& block) const {
    constexpr std::size_t head = 24;
    const auto kind = block.data.substr(0, 2);
    const auto zip_type = block.number<std::uint8_t>(2);
    const auto columns = block.number<std::uint32_t>(4);
    const auto whole = block.number<std::uint64_t>(8);
    const auto zipped = block.number<std::uint64_t>(16);
    if ((kind != "DT" && kind != "SD") || zip_type > 1 || block.data.size() < head ||
        zipped > block.data.size() - head) {
        refuse(block.at, "a compressed block of an unknown kind, or truncated");
    }
    unzipped_bytes_ += whole;
    if (whole > max_decompressed_bytes || unzipped_bytes_ > max_decompressed_bytes ||
        (unzipped_bytes_ > free_decompressed_bytes &&
         unzipped_bytes_ / max_expansion > bytes_.size())) {
        refuse(block.at, "expands to more than 1 GiB, or 100 times the size of the file");
    }
    std::string bytes(whole, '\0');
    auto size = static_cast<uLongf>(whole);
    const auto* const from = block.data.data() + head;
    if (uncompress(reinterpret_cast<Bytef*>(bytes.data()), // NOLINT(*-reinterpret-cast)
                   &size,
                   reinterpret_cast<const Bytef*>(from), // NOLINT(*-reinterpret-cast)
                   static_cast<uLong>(zipped)) != Z_OK ||
        size != whole) {
        refuse(block.at, "compressed data are damaged");
    }
    if (zip_type == 1 && columns > 0) {
        const std::size_t lines = bytes.size() / columns;
        std::string turned = bytes; // what does not fill a line stays at the end
        for (std::size_t line = 0; line < lines; ++line) {
            for (std::size_t column = 0; column < columns; ++column) {
                turned[line * columns + column] = bytes[column * lines + line];
            }
        }
        return turned;
    }
    return bytes;
}

} // namespace macadam
