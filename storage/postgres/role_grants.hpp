#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace macadam {

/// Statement that grants rights to those of some roles that the server has: roles belong to the
/// whole server, and its administrator may do without ours.
///
/// \param rights  "SELECT ON macadam.job"; our own words, without quotation marks
std::string granting(std::string_view rights, std::initializer_list<std::string_view> roles);

/// The same to the owner of schema macadam.
std::string granting_to_owner(std::string_view rights);

} // namespace macadam
