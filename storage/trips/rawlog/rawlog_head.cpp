#include "storage/trips/rawlog/rawlog_head.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t longest_name = 120; // limit of MRPT's reader

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
