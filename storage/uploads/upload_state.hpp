#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace macadam {

/// Fate of a log that was sent or submitted: `known` were imported before, by another way;
/// `outside` touch no road; `refused` hold no usable trip; `parked` failed too often for another
/// cause.
enum class UploadState : std::uint8_t {
    queued,
    working,
    imported,
    known,
    outside,
    refused,
    parked
};

inline constexpr std::array all_upload_states{UploadState::queued,
                                              UploadState::working,
                                              UploadState::imported,
                                              UploadState::known,
                                              UploadState::outside,
                                              UploadState::refused,
                                              UploadState::parked};

std::string_view name_of(UploadState state);

/// Returns the state of a name in a database; `refused` for an unknown one.
UploadState state_named(std::string_view name);

/// Tests whether a log waits or is worked on.
constexpr bool is_waiting(UploadState state) {
    return state == UploadState::queued || state == UploadState::working;
}

/// Tests whether a log that is sent again gets another try.
constexpr bool is_tried_again(UploadState state) {
    return state == UploadState::outside || state == UploadState::refused ||
           state == UploadState::parked;
}

} // namespace macadam
