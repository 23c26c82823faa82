#include "storage/trips/rawlog/rawlog_layout.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <utility>

namespace macadam {

namespace {

static_assert(std::endian::native == std::endian::little, "rawlogs are little-endian");

constexpr std::size_t longest_name = 120; // limit of MRPT's reader
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
class Walk {
public:
    explicit Walk(std::string_view bytes) : bytes_{bytes} {}

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

void walk_imu(Walk& walk, const RawlogHead& head) {
    walk.pose_3d();
    if (head.version == 4) {
        walk.flags(imu_channels);
        walk.skip(time_size + imu_channels * sizeof(double));
    } else if (head.version < 4) {
        walk.flags(walk.count(imu_channels));
        walk.skip(time_size);
        walk.skip(walk.count(imu_channels) * (head.version == 0 ? sizeof(float) : sizeof(double)));
    } else {
        refuse(head, "a version up to 4");
    }
    walk.text();
}

void walk_odometry(Walk& walk, const RawlogHead& head) {
    if (head.version > 2) {
        refuse(head, "a version up to 2");
    }
    walk.pose_2d();
    walk.text();
    walk.skip(time_size);
    if (head.version == 0) {
        return;
    }
    const bool always = head.version == 1;
    if (walk.flag() || always) {
        walk.skip(2 * sizeof(std::int32_t));
    }
    if (walk.flag() || always) {
        walk.skip(always ? 2 * sizeof(float) : 3 * sizeof(double));
    }
}

void walk_comment(Walk& walk, const RawlogHead& head) {
    if (head.version != 0) {
        refuse(head, "version 0");
    }
    walk.text();
    walk.skip(time_size);
}

/// Messages in the form of a length and a block: GGA, GLL, GSA, RMC, VTG and ZDA of NMEA 0183.
bool is_block(std::uint32_t message) {
    static constexpr std::array<std::uint32_t, 6> types{10, 11, 12, 15, 16, 17};
    return std::ranges::find(types, message) != types.end();
}

/// \returns whether every message was recognised.
bool walk_gps(Walk& walk, const RawlogHead& head) {
    constexpr std::size_t max_messages = 1000; // one of each type, and there are fewer types
    constexpr std::size_t max_message_bytes = 1000;
    walk.skip(2 * time_size);
    walk.text();
    walk.pose_3d();
    if (head.version == 11) {
        walk.flag();
    } else if (head.version != 10) {
        refuse(head, "a version from 3 to 11");
    }
    for (auto messages = walk.count(max_messages); messages > 0; --messages) {
        if (!is_block(walk.number())) {
            return false;
        }
        walk.skip(walk.count(max_message_bytes));
    }
    return true;
}

void walk_topcon_position(Walk& walk, int version) {
    walk.skip(5 * sizeof(double) + sizeof(float) + 5);
    if (version < 6) {
        return;
    }
    walk.flag();
    walk.skip(6 * sizeof(double));
    walk.flag();
    walk.matrix();
    walk.flag();
    walk.matrix();
    walk.flag();
    walk.skip(version >= 8 ? 3 : 2);
}

bool is_old_gps(const RawlogHead& head) {
    return head.kind == RawlogClass::gps && head.version >= 3 && head.version <= 9;
}

/// Steps over the NMEA 0183 fields as MRPT wrote them before 1.4, including the position of the
/// receiver.
void walk_old_nmea(Walk& walk, int version) {
    constexpr std::size_t clock = 2 + sizeof(double);
    walk.skip(time_size);
    if (walk.flag()) { // GGA
        walk.skip(clock + 2 * sizeof(double) + 1 + sizeof(double));
        walk.skip(version >= 9 ? 3 * sizeof(double) : 0);
        walk.skip(sizeof(std::uint32_t));
        walk.flag();
        walk.skip(sizeof(float));
    }
    if (walk.flag()) { // RMC
        walk.skip(clock + 1 + 4 * sizeof(double));
    }
    walk.text();
    if (version >= 4) {
        walk.pose_3d();
    }
}

/// Steps over the additional fields of Topcon receivers.
void walk_old_topcon(Walk& walk, int version) {
    if (version >= 5 && walk.flag()) {
        walk_topcon_position(walk, version);
    }
    if (version >= 7 && walk.flag()) { // satellites in view
        for (const std::size_t item : {1, 1, 2}) {
            walk.skip(item * walk.count(max_items));
        }
    }
}

/// \returns whether the end of the object is known from its fields.
bool walk_object(Walk& walk, const RawlogHead& head) {
    switch (head.kind) {
    case RawlogClass::imu:
        walk_imu(walk, head);
        return true;
    case RawlogClass::odometry:
        walk_odometry(walk, head);
        return true;
    case RawlogClass::comment:
        walk_comment(walk, head);
        return true;
    case RawlogClass::gps:
        if (is_old_gps(head)) {
            walk_old_nmea(walk, head.version);
            walk_old_topcon(walk, head.version);
            return true;
        }
        return walk_gps(walk, head);
    case RawlogClass::frame:
    case RawlogClass::other:
        break;
    }
    return false;
}

RawlogClass class_named(std::string_view name) {
    using Row = std::pair<std::string_view, RawlogClass>;
    static constexpr std::array<Row, 5> table{{{"CObservationIMU", RawlogClass::imu},
                                               {"CObservationGPS", RawlogClass::gps},
                                               {"CObservationOdometry", RawlogClass::odometry},
                                               {"CObservationComment", RawlogClass::comment},
                                               {"CSensoryFrame", RawlogClass::frame}}};
    const auto found = std::ranges::find(table, name, &Row::first);
    return found == table.end() ? RawlogClass::other : found->second;
}

bool is_in_names(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == ':' || c == '<' ||
           c == '>' || c == ',';
}

/// Class name at the front of `bytes`, as far as available; `std::nullopt`: not a class name.
std::optional<std::string_view> full_name_in(std::string_view bytes) {
    constexpr unsigned char new_format = 0x80;
    const auto first = static_cast<unsigned char>(bytes.front());
    const std::size_t length = first & ~unsigned{new_format};
    const auto name = bytes.substr(1, length);
    const bool is_name = (first & new_format) != 0 && length > 0 && length <= longest_name &&
                         std::ranges::all_of(name, is_in_names);
    return is_name ? std::optional{name} : std::nullopt;
}

} // namespace

std::optional<RawlogHead> rawlog_head(std::string_view bytes) {
    if (bytes.empty()) {
        return std::nullopt;
    }
    const auto full_name = full_name_in(bytes);
    if (!full_name) {
        throw InputError{
            fmt::format("{}, expected an object of MRPT", in_quotes(bytes.substr(0, 20)))};
    }
    const std::size_t length = static_cast<unsigned char>(bytes.front()) & 0x7fU;
    if (bytes.size() < length + 2) {
        return std::nullopt;
    }
    const auto name = full_name->substr(full_name->rfind(':') + 1); // 0 if there is none
    return RawlogHead{.kind = class_named(name),
                      .name = std::string{name},
                      .version = static_cast<unsigned char>(bytes[length + 1]),
                      .size = length + 2};
}

std::optional<std::size_t> rawlog_size(const RawlogHead& head, std::string_view bytes) {
    try {
        Walk walk{bytes};
        walk.skip(head.size);
        if (!walk_object(walk, head)) {
            return 0;
        }
        walk.end();
        return walk.at();
    } catch (const MoreNeeded&) {
        return std::nullopt;
    }
}

std::optional<std::string> without_topcon(std::string_view object) {
    const auto head = rawlog_head(object);
    if (!head || !is_old_gps(*head) || head->version < 5) {
        return std::nullopt;
    }
    Walk walk{object};
    walk.skip(head->size);
    walk_old_nmea(walk, head->version);
    std::string bytes{object.substr(0, walk.at())};
    bytes.append(head->version >= 7 ? 2 : 1, '\0'); // flags: no position, no satellites
    bytes += rawlog_end_flag;
    return bytes;
}

std::optional<RawlogFrame> rawlog_frame(const RawlogHead& head, std::string_view bytes) {
    if (head.version != 2) {
        refuse(head, "version 2");
    }
    try {
        Walk walk{bytes};
        walk.skip(head.size);
        const auto count = walk.count(max_items);
        return RawlogFrame{.count = count, .size = walk.at()};
    } catch (const MoreNeeded&) {
        return std::nullopt;
    }
}

std::optional<bool> begins_observation(std::string_view bytes) {
    if (!bytes.empty() && !full_name_in(bytes)) {
        return false; // no exception here: an image has many positions to test
    }
    const auto head = rawlog_head(bytes);
    if (!head) {
        return std::nullopt;
    }
    return head->name.starts_with("CObservation") || head->name == "CSensoryFrame" ||
           head->name == "CActionCollection";
}

} // namespace macadam
