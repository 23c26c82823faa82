#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Block of an MDF 4 file: links to other blocks, and data.
struct MdfBlock {
    std::uint64_t at = 0; ///< byte of the file
    std::string_view id;  ///< "CN"
    std::string_view links;
    std::string_view data;

    std::uint64_t link(std::size_t i) const; ///< 0 = none, also beyond the last
    std::size_t link_count() const { return links.size() / 8; }

    template <typename Number>
    Number number(std::size_t offset) const; ///< of the data; 0 beyond its end
};

/// Blocks of an MDF 4 file in memory. Every link is checked.
///
/// Source: ASAM MDF, version 4.1.0 (2012), "Programmers guide", chapter 5.
class MdfBlocks {
public:
    /// \throws InputError  "file: ..." if it is not MDF 4, or not finalised.
    MdfBlocks(std::string_view bytes, std::string name);

    /// Block at a link.
    ///
    /// \param ids  allowed block types, of two letters each: "DTDZDLHL"
    /// \throws InputError  "file: byte N: ..." if there is no such block within the file.
    MdfBlock block(std::uint64_t at, std::string_view ids) const;

    MdfBlock head() const { return block(64, "HD"); }

    /// Blocks of a list, by the first of their links. Each block belongs to one list, which is read
    /// once.
    std::vector<MdfBlock> chain(std::uint64_t first, std::string_view id) const;

    /// Text of a TX block, or of the element TX of an MD block; "" for link 0.
    std::string text(std::uint64_t at) const;

    /// Passes on the data at a link, block by block: DT, SD, DZ (deflated), and lists of these.
    /// Data that expand beyond the limits of compressed files (docs/reference/trip-logs.md) are
    /// refused.
    void each_data(std::uint64_t at, const std::function<void(std::string_view)>& take) const;

    [[noreturn]] void refuse(std::uint64_t at, std::string_view words) const;

private:
    std::string unzipped(const MdfBlock& block) const;

    std::string_view bytes_;
    std::string name_;
    void take_once(std::uint64_t at) const;

    mutable std::uint64_t unzipped_bytes_ = 0;
    mutable std::set<std::uint64_t> taken_; ///< blocks of lists, and data
};

} // namespace macadam
