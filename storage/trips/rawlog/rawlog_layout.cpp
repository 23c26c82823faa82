#include "storage/trips/rawlog/rawlog_layout.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

namespace macadam {

namespace {

static_assert(std::endian::native == std::endian::little, "rawlogs are little-endian");

constexpr std::size_t longest_text = 16 << 20;
constexpr std::size_t max_items = 1 << 20;
constexpr std::size_t imu_channels = 31; // of MRPT 2: enumeration TIMUDataIndex

/// Thrown at the end of the available bytes.
struct MoreNeeded {};

[[noreturn]] void refuse(const RawlogHead& head, std::string_view expected) {
    throw InputError{
        fmt::format("{} of version {}, expected {}", head.name, head.version, expected)};
}

/// Steps over the fields of an object.
class ObjectCursor {
public:
    explicit ObjectCursor(std::string_view bytes) : bytes_{bytes} {}

    std::size_t at() const { return at_; }

    void skip(std::size_t count) {
        if (count > bytes_.size() - at_) {
            throw MoreNeeded{};
        }
        at_ += count;
    }

    std::uint32_t number() {
        const auto from = at_;
        skip(sizeof(std::uint32_t));
        std::uint32_t value = 0;
        std::memcpy(&value, bytes_.data() + from, sizeof(value));
        return value;
    }

    /// Reads a byte that MRPT interprets as a bool.
    bool flag() {
        const auto from = at_;
        skip(1);
        const char byte = bytes_[from];
        if (byte != 0 && byte != 1) {
            throw InputError{
                fmt::format("a flag is {}, expected 0 or 1", static_cast<unsigned char>(byte))};
        }
        return byte != 0;
    }

    void flags(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            flag();
        }
    }

    std::size_t count(std::size_t most) {
        const auto value = number();
        if (value > most) {
            throw InputError{fmt::format("{} items, expected at most {}", value, most)};
        }
        return value;
    }

    void text() {
        const auto size = number();
        if (size > longest_text) {
            throw InputError{
                fmt::format("a text of {} bytes, expected at most {}", size, longest_text)};
        }
        skip(size);
    }

    /// Steps over a nested object; `fields` steps over its fields.
    template <typename Fields>
    void object(std::string_view expected, Fields fields) {
        const auto head = rawlog_head(bytes_.substr(at_));
        if (!head) {
            throw MoreNeeded{};
        }
        if (!head->name.starts_with(expected)) {
            throw InputError{
                fmt::format("it contains {}, expected {}", in_quotes(head->name), expected)};
        }
        skip(head->size);
        fields(*head);
        end();
    }

    void end() {
        const auto from = at_;
        skip(1);
        if (bytes_[from] != rawlog_end_flag) {
            throw InputError{fmt::format("{}, expected the end of the object ('\\x88')",
                                         in_quotes(bytes_.substr(from, 1)))};
        }
    }

    void matrix() {
        object("CMatrix", [&](const RawlogHead& head) {
            const auto rows = count(4); // of poses and covariances
            const auto columns = count(4);
            skip(rows * columns * (head.name == "CMatrixD" ? sizeof(double) : sizeof(float)));
        });
    }

    void pose_3d() {
        object("CPose3D", [&](const RawlogHead& head) {
            switch (head.version) {
            case 0:
            case 1:
                matrix();
                break;
            case 2: // three coordinates and a quaternion
                skip(7 * sizeof(double));
                break;
            case 3: // three coordinates and a rotation matrix
                skip(12 * sizeof(double));
                break;
            default:
                refuse(head, "a version up to 3");
            }
        });
    }

    void pose_2d() {
        object("CPose2D", [&](const RawlogHead& head) {
            if (head.version > 1) {
                refuse(head, "a version up to 1");
            }
            skip(3 * (head.version == 0 ? sizeof(float) : sizeof(double)));
        });
    }

private:
    std::string_view bytes_;
    std::size_t at_ = 0;
};

constexpr std::size_t time_size = 8;

void skip_imu(ObjectCursor& cursor, const RawlogHead& head) {
    cursor.pose_3d();
    if (head.version == 4) {
        cursor.flags(imu_channels);
        cursor.skip(time_size + imu_channels * sizeof(double));
    } else if (head.version < 4) {
        cursor.flags(cursor.count(imu_channels));
        cursor.skip(time_size);
        cursor.skip(cursor.count(imu_channels) *
                    (head.version == 0 ? sizeof(float) : sizeof(double)));
    } else {
        refuse(head, "a version up to 4");
    }
    cursor.text();
}

void skip_odometry(ObjectCursor& cursor, const RawlogHead& head) {
    if (head.version > 2) {
        refuse(head, "a version up to 2");
    }
    cursor.pose_2d();
    cursor.text();
    cursor.skip(time_size);
    if (head.version == 0) {
        return;
    }
    const bool always = head.version == 1;
    if (cursor.flag() || always) {
        cursor.skip(2 * sizeof(std::int32_t));
    }
    if (cursor.flag() || always) {
        cursor.skip(always ? 2 * sizeof(float) : 3 * sizeof(double));
    }
}

void skip_comment(ObjectCursor& cursor, const RawlogHead& head) {
    if (head.version != 0) {
        refuse(head, "version 0");
    }
    cursor.text();
    cursor.skip(time_size);
}

/// Messages in the form of a length and a block: GGA, GLL, GSA, RMC, VTG and ZDA of NMEA 0183.
bool is_block(std::uint32_t message) {
    static constexpr std::array<std::uint32_t, 6> types{10, 11, 12, 15, 16, 17};
    return std::ranges::find(types, message) != types.end();
}

/// \returns whether every message was recognised.
bool skip_gps(ObjectCursor& cursor, const RawlogHead& head) {
    constexpr std::size_t max_messages = 1000; // one of each type, and there are fewer types
    constexpr std::size_t max_message_bytes = 1000;
    cursor.skip(2 * time_size);
    cursor.text();
    cursor.pose_3d();
    if (head.version == 11) {
        cursor.flag();
    } else if (head.version != 10) {
        refuse(head, "a version from 3 to 11");
    }
    for (auto messages = cursor.count(max_messages); messages > 0; --messages) {
        if (!is_block(cursor.number())) {
            return false;
        }
        cursor.skip(cursor.count(max_message_bytes));
    }
    return true;
}

void skip_topcon_position(ObjectCursor& cursor, int version) {
    cursor.skip(5 * sizeof(double) + sizeof(float) + 5);
    if (version < 6) {
        return;
    }
    cursor.flag();
    cursor.skip(6 * sizeof(double));
    cursor.flag();
    cursor.matrix();
    cursor.flag();
    cursor.matrix();
    cursor.flag();
    cursor.skip(version >= 8 ? 3 : 2);
}

bool is_old_gps(const RawlogHead& head) {
    return head.kind == RawlogClass::gps && head.version >= 3 && head.version <= 9;
}

/// Steps over the NMEA 0183 fields as MRPT wrote them before 1.4, including the position of the
/// receiver.
void skip_old_nmea(ObjectCursor& cursor, int version) {
    constexpr std::size_t clock = 2 + sizeof(double);
    cursor.skip(time_size);
    if (cursor.flag()) { // GGA
        cursor.skip(clock + 2 * sizeof(double) + 1 + sizeof(double));
        cursor.skip(version >= 9 ? 3 * sizeof(double) : 0);
        cursor.skip(sizeof(std::uint32_t));
        cursor.flag();
        cursor.skip(sizeof(float));
    }
    if (cursor.flag()) { // RMC
        cursor.skip(clock + 1 + 4 * sizeof(double));
    }
    cursor.text();
    if (version >= 4) {
        cursor.pose_3d();
    }
}

/// Steps over the additional fields of Topcon receivers.
void skip_old_topcon(ObjectCursor& cursor, int version) {
    if (version >= 5 && cursor.flag()) {
        skip_topcon_position(cursor, version);
    }
    if (version >= 7 && cursor.flag()) { // satellites in view
        for (const std::size_t item : {1, 1, 2}) {
            cursor.skip(item * cursor.count(max_items));
        }
    }
}

/// \returns whether the end of the object is known from its fields.
bool skip_object(ObjectCursor& cursor, const RawlogHead& head) {
    switch (head.kind) {
    case RawlogClass::imu:
        skip_imu(cursor, head);
        return true;
    case RawlogClass::odometry:
        skip_odometry(cursor, head);
        return true;
    case RawlogClass::comment:
        skip_comment(cursor, head);
        return true;
    case RawlogClass::gps:
        if (is_old_gps(head)) {
            skip_old_nmea(cursor, head.version);
            skip_old_topcon(cursor, head.version);
            return true;
        }
        return skip_gps(cursor, head);
    case RawlogClass::frame:
    case RawlogClass::other:
        break;
    }
    return false;
}

} // namespace

std::optional<std::size_t> rawlog_size(const RawlogHead& head, std::string_view bytes) {
    try {
        ObjectCursor cursor{bytes};
        cursor.skip(head.size);
        if (!skip_object(cursor, head)) {
            return 0;
        }
        cursor.end();
        return cursor.at();
    } catch (const MoreNeeded&) {
        return std::nullopt;
    }
}

std::optional<std::string> without_topcon(std::string_view object) {
    const auto head = rawlog_head(object);
    if (!head || !is_old_gps(*head) || head->version < 5) {
        return std::nullopt;
    }
    ObjectCursor cursor{object};
    cursor.skip(head->size);
    skip_old_nmea(cursor, head->version);
    std::string bytes{object.substr(0, cursor.at())};
    bytes.append(head->version >= 7 ? 2 : 1, '\0'); // flags: no position, no satellites
    bytes += rawlog_end_flag;
    return bytes;
}

std::optional<RawlogFrame> rawlog_frame(const RawlogHead& head, std::string_view bytes) {
    if (head.version != 2) {
        refuse(head, "version 2");
    }
    try {
        ObjectCursor cursor{bytes};
        cursor.skip(head.size);
        const auto count = cursor.count(max_items);
        return RawlogFrame{.count = count, .size = cursor.at()};
    } catch (const MoreNeeded&) {
        return std::nullopt;
    }
}

} // namespace macadam
