#pragma once

#include <string>
#include <string_view>

namespace macadam {

/// Network by which clients are told apart: an IPv4 address, or the first 64 bits of an IPv6
/// address, all of which one client has (RFC 6177), "2001:db8::/64". Other text stays as it is.
std::string client_network(std::string_view address);

} // namespace macadam
