#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace macadam {

/// Privacy profile of a database: the owner of its cars determines which data may leave it
/// (docs/privacy.md).
enum class PrivacyProfile : std::uint8_t {
    own,   ///< the user's own cars: no anonymisation
    crowd, ///< cars of others
};

constexpr std::string_view name_of(PrivacyProfile profile) {
    return profile == PrivacyProfile::crowd ? "crowd" : "own";
}

constexpr std::optional<PrivacyProfile> privacy_profile_named(std::string_view name) {
    for (const auto profile : {PrivacyProfile::own, PrivacyProfile::crowd}) {
        if (name == name_of(profile)) {
            return profile;
        }
    }
    return std::nullopt;
}

} // namespace macadam
