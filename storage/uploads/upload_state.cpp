#include "storage/uploads/upload_state.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace macadam {
namespace {

constexpr std::array<std::string_view, 7> state_names{
    "queued", "working", "imported", "known", "outside", "refused", "parked"};

} // namespace

std::string_view name_of(UploadState state) {
    return state_names.at(static_cast<std::size_t>(state));
}

UploadState state_named(std::string_view name) {
    const auto* const found = std::ranges::find(state_names, name);
    return found == state_names.end() ? UploadState::refused
                                      : static_cast<UploadState>(found - state_names.begin());
}

} // namespace macadam
