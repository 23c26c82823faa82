#include "storage/store/server/drive_body.hpp"

#include "estimator/common/error.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <tuple>

namespace macadam {
namespace {

constexpr char format_1 = 1;

enum : unsigned char { knows_left = 1, knows_right = 2, knows_centre = 4, is_centre_only = 8 };
constexpr unsigned char all_flags = knows_left | knows_right | knows_centre | is_centre_only;

/// Values of the pass before, from which differences are taken.
struct Before {
    std::uint32_t offset = 0;
    std::int64_t left = 0;
    std::int64_t right = 0;
    std::int64_t centre = 0;
    std::int64_t iri = 0;
    std::int64_t sd = 0;
    std::int64_t speed = 0;
    std::int64_t covered = 0;
    std::int64_t confidence = 0;
    std::int64_t t = 0;
};

/// Value from which the IRI of a pass differs little.
std::int64_t expected_iri(const Pass& pass, const Before& before) {
    return pass.iri_left_um && pass.iri_right_um
               ? (std::int64_t{*pass.iri_left_um} + *pass.iri_right_um) / 2
               : before.iri;
}

// Differences wrap around, so that every pair of values has one.

std::uint64_t zigzag(std::int64_t from, std::int64_t to) {
    const auto difference = static_cast<std::uint64_t>(to) - static_cast<std::uint64_t>(from);
    return difference << 1 ^ (0 - (difference >> 63));
}

std::int64_t plus_zigzag(std::int64_t from, std::uint64_t coded) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(from) +
                                     (coded >> 1 ^ (0 - (coded & 1))));
}

void append(std::string& to, std::uint64_t number) {
    for (; number >= 0x80; number >>= 7) {
        to.push_back(static_cast<char>(number | 0x80));
    }
    to.push_back(static_cast<char>(number));
}

template <typename Value>
void append_change(std::string& to, std::int64_t& before, Value value) {
    append(to, zigzag(before, value));
    before = value;
}

[[noreturn]] void refuse() {
    throw InputError{"the packed passes of a drive are invalid"};
}

class Bytes {
public:
    explicit Bytes(std::string_view bytes) : bytes_{bytes} {}

    bool empty() const { return bytes_.empty(); }

    unsigned char byte() {
        if (bytes_.empty()) {
            refuse();
        }
        const auto value = static_cast<unsigned char>(bytes_.front());
        bytes_.remove_prefix(1);
        return value;
    }

    std::uint64_t number() {
        std::uint64_t number = 0;
        for (int shift = 0; shift < 64; shift += 7) {
            const std::uint64_t part = byte();
            if (shift == 63 && part > 1) {
                refuse();
            }
            number |= (part & 0x7F) << shift;
            if (part < 0x80) {
                return number;
            }
        }
        refuse();
    }

    std::uint32_t small_number() {
        const auto value = number();
        if (value > std::numeric_limits<std::uint32_t>::max()) {
            refuse();
        }
        return static_cast<std::uint32_t>(value);
    }

    /// Value that differs from one before, which it replaces.
    std::int64_t change(std::int64_t& before) {
        before = plus_zigzag(before, number());
        return before;
    }

    std::int32_t small_change(std::int64_t& before) {
        const auto value = change(before);
        if (value < std::numeric_limits<std::int32_t>::min() ||
            value > std::numeric_limits<std::int32_t>::max()) {
            refuse();
        }
        return static_cast<std::int32_t>(value);
    }

private:
    std::string_view bytes_;
};

void append_pass(std::string& body, const DrivePass& drive_pass, Before& before) {
    const auto& [offset, pass] = drive_pass;
    append(body, offset - before.offset);
    before.offset = offset;
    append(body, pass.occurrence);
    body.push_back(static_cast<char>(
        (pass.iri_left_um ? knows_left : 0) | (pass.iri_right_um ? knows_right : 0) |
        (pass.iri_centre_um ? knows_centre : 0) | (pass.centre_only ? is_centre_only : 0)));
    body.push_back(static_cast<char>(pass.validity));
    const auto append_known = [&](std::int64_t& last, const std::optional<IriUm>& value) {
        if (value) {
            append_change(body, last, *value);
        }
    };
    append_known(before.left, pass.iri_left_um);
    append_known(before.right, pass.iri_right_um);
    append_known(before.centre, pass.iri_centre_um);
    before.iri = expected_iri(pass, before);
    append_change(body, before.iri, pass.iri_um);
    append_change(body, before.sd, pass.sd_um);
    append_change(body, before.speed, pass.speed_mmps);
    append_change(body, before.covered, pass.covered_mm);
    append_change(body, before.confidence, pass.confidence_ppm);
    append_change(body, before.t, pass.t_ms);
}

DrivePass pass_in(Bytes& bytes, Before& before, std::uint32_t segments_per_chunk) {
    DrivePass result{};
    const std::uint64_t offset = std::uint64_t{before.offset} + bytes.small_number();
    if (offset >= segments_per_chunk) {
        refuse();
    }
    result.offset = before.offset = static_cast<std::uint32_t>(offset);
    auto& pass = result.pass;
    pass.occurrence = bytes.small_number();
    const auto flags = bytes.byte();
    if ((flags & ~all_flags) != 0) {
        refuse();
    }
    pass.validity = bytes.byte();
    const auto known = [&](unsigned char flag, std::int64_t& last) {
        return (flags & flag) != 0 ? std::optional<IriUm>{bytes.small_change(last)} : std::nullopt;
    };
    pass.iri_left_um = known(knows_left, before.left);
    pass.iri_right_um = known(knows_right, before.right);
    pass.iri_centre_um = known(knows_centre, before.centre);
    pass.centre_only = (flags & is_centre_only) != 0;
    before.iri = expected_iri(pass, before);
    pass.iri_um = bytes.small_change(before.iri);
    pass.sd_um = bytes.small_change(before.sd);
    pass.speed_mmps = bytes.small_change(before.speed);
    pass.covered_mm = bytes.small_change(before.covered);
    pass.confidence_ppm = bytes.small_change(before.confidence);
    pass.t_ms = bytes.change(before.t);
    return result;
}

} // namespace

std::string body_of(std::vector<DrivePass> passes) {
    std::ranges::sort(passes, {}, [](const DrivePass& drive_pass) {
        return std::tuple{drive_pass.offset, drive_pass.pass.occurrence};
    });
    std::string body(1, format_1);
    Before before;
    for (const auto& pass : passes) {
        append_pass(body, pass, before);
    }
    return body;
}

std::vector<DrivePass> passes_in_body(std::string_view body, std::uint32_t segments_per_chunk) {
    Bytes bytes{body};
    if (bytes.byte() != format_1) {
        refuse();
    }
    std::vector<DrivePass> passes;
    for (Before before; !bytes.empty();) {
        passes.push_back(pass_in(bytes, before, segments_per_chunk));
    }
    return passes;
}

} // namespace macadam
