#include "storage/postgres/sqlstate.hpp"

namespace macadam {
namespace {

/// Tests for the ends of statements and sessions that the same work need not meet again: cancelled,
/// a deadlock, a limit of time.
bool is_passing(std::string_view state) {
    return state.starts_with("40") || state == "57014" || state == "57P05" || state == "55P03" ||
           state == "25P03";
}

} // namespace

std::string_view advice_for(std::string_view state) {
    if (state == "42501") { // insufficient_privilege
        return "; the role needs more rights: its owner grants macadam_operator "
               "(docs/reference/postgresql.md)";
    }
    if (state == "0A000" || state == "58P01" || state == "22023") {
        return "";
    }
    if (state == "53100" || state == "53200") {
        return "; nothing was changed, run the command again when the server has room";
    }
    if (is_passing(state)) {
        return "; run the command again";
    }
    return "";
}

bool is_trouble(std::string_view state) {
    return state.empty() || state.starts_with("08") || state.starts_with("53") ||
           state.starts_with("57") || state.starts_with("58") || is_passing(state);
}

} // namespace macadam
