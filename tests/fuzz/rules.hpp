#pragma once

#include "estimator/common/error.hpp"

#include <stdexcept>
#include <string>
#include <string_view>

namespace macadam::fuzz {

/// What must hold whatever the input was. \throws std::logic_error, which is a finding.
inline void expect(bool holds, const char* what) {
    if (!holds) {
        throw std::logic_error{std::string{"expected that "} + what};
    }
}

/// Calls a reader, which may answer with a refusal in words.
template <typename Refusal = InputError, typename Call>
void may_refuse(Call call) {
    try {
        call();
    } catch (const Refusal& refusal) {
        expect(!std::string_view{refusal.what()}.empty(), "a refusal has words");
    }
}

} // namespace macadam::fuzz
