#pragma once

#include "targets.hpp"

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
Answer may_refuse(Call call) {
    try {
        call();
        return Answer::accepted;
    } catch (const Refusal& refusal) {
        expect(!std::string_view{refusal.what()}.empty(), "a refusal has words");
        return Answer::refused;
    }
}

/// Joins the answers of one input read in several ways, all of which must do.
inline Answer both(Answer one, Answer other) {
    return one == Answer::accepted ? other : Answer::refused;
}

/// Joins those of which one must do.
inline Answer either(Answer one, Answer other) {
    return one == Answer::accepted ? Answer::accepted : other;
}

} // namespace macadam::fuzz
