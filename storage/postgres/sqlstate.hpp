#pragma once

#include <string_view>

namespace macadam {

// Error codes of a server. Source: PostgreSQL 15, appendix A.

/// Advice on an error, to follow its words; "" if there is none.
std::string_view advice_for(std::string_view state);

/// Tests for errors that tell nothing about what was asked: the same work may succeed later.
/// \param state  "" if the server gave none: the connection broke
bool is_trouble(std::string_view state);

} // namespace macadam
