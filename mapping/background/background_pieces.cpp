#include "mapping/background/background_pieces.hpp"

#include "estimator/common/error.hpp"
#include "mapping/background/background_levels.hpp"

#include <fmt/format.h>

#include <optional>

namespace macadam {
namespace {

constexpr unsigned bits_per_byte = 7;
constexpr std::uint8_t more_follow = 0x80;

void append_number(std::string& bytes, std::uint32_t number) {
    for (; number >= more_follow; number >>= bits_per_byte) {
        bytes += static_cast<char>(number | more_follow);
    }
    bytes += static_cast<char>(number);
}

/// Maps 0, -1, 1, -2, ... to 0, 1, 2, 3, ...
std::uint32_t zigzag(std::int32_t number) {
    const auto twice = static_cast<std::uint32_t>(number) << 1U;
    return number < 0 ? ~twice : twice;
}

std::int32_t unzigzag(std::uint32_t number) {
    return static_cast<std::int32_t>((number >> 1U) ^ (0U - (number & 1U)));
}

/// Reads numbers of untrusted bytes.
class Numbers {
public:
    explicit Numbers(std::string_view bytes) : bytes_{bytes} {}

    bool at_end() const { return at_ == bytes_.size(); }
    std::size_t left() const { return bytes_.size() - at_; }

    std::uint32_t next() {
        constexpr unsigned max_shift = 28;
        std::uint32_t number = 0;
        for (unsigned shift = 0; shift <= max_shift && at_ < bytes_.size();
             shift += bits_per_byte) {
            const auto byte = static_cast<std::uint8_t>(bytes_[at_++]);
            number |= static_cast<std::uint32_t>(byte & (more_follow - 1U)) << shift;
            if (byte < more_follow) {
                return number;
            }
        }
        throw InputError{"a number of the background is cut off or too long"};
    }

    /// Next number, of things of which each takes `bytes` bytes or more.
    std::size_t count(std::size_t bytes, std::size_t least) {
        const std::size_t number = next();
        if (number < least || number > left() / bytes) {
            throw InputError{
                fmt::format("the background has {} points or paths in {} bytes", number, left())};
        }
        return number;
    }

private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

/// Adds a difference to a cell; `std::nullopt` outside the tile.
std::optional<std::int32_t> moved(std::int32_t cell, std::uint32_t difference) {
    const auto sum = std::int64_t{cell} + unzigzag(difference);
    return sum >= 0 && sum <= background_cells ? std::optional{static_cast<std::int32_t>(sum)}
                                               : std::nullopt;
}

} // namespace

void append_piece(std::string& bytes, const BackgroundPiece& piece) {
    bytes += static_cast<char>(piece.kind);
    append_number(bytes, static_cast<std::uint32_t>(piece.paths.size()));
    CellPoint last{0, 0};
    for (const auto& path : piece.paths) {
        append_number(bytes, static_cast<std::uint32_t>(path.size()));
        for (const auto& point : path) {
            append_number(bytes, zigzag(point.x - last.x));
            append_number(bytes, zigzag(point.y - last.y));
            last = point;
        }
    }
}

void visit_pieces(std::string_view bytes,
                  const std::function<void(const BackgroundPiece&)>& visit) {
    constexpr std::size_t bytes_per_point = 2;
    constexpr std::size_t bytes_per_path = 1 + bytes_per_point;
    Numbers numbers{bytes};
    BackgroundPiece piece{};
    while (!numbers.at_end()) {
        const auto kind = numbers.next();
        if (kind >= background_kinds) {
            throw InputError{fmt::format("kind {} in the background", kind)};
        }
        piece.kind = static_cast<BackgroundKind>(kind);
        const std::size_t least = is_line_kind(piece.kind) ? 2 : 3;
        piece.paths.resize(numbers.count(bytes_per_path, 1));
        CellPoint at{0, 0};
        for (auto& path : piece.paths) {
            path.resize(numbers.count(bytes_per_point, least));
            for (auto& point : path) {
                const auto x = moved(at.x, numbers.next());
                const auto y = moved(at.y, numbers.next());
                if (!x || !y) {
                    throw InputError{"a point of the background is outside its tile"};
                }
                at = {*x, *y};
                point = at;
            }
        }
        visit(piece);
    }
}

} // namespace macadam
