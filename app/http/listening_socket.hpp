#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace macadam {

/// Opens a TCP socket that listens on an address of this machine, such as "127.0.0.1" or "::1".
/// \param port  0: any free one.
/// \throws InputError  if there is no such address, or its port is in use.
int open_listening_socket(const std::string& host, std::uint16_t port);

/// Opens a Unix socket that listens, for its owner and group alone (0660). One that a killed server
/// left is replaced.
/// \throws InputError  if the path is too long or another file's, or a server listens there.
int open_listening_socket(const std::filesystem::path& file);

/// Port of a listening TCP socket.
std::uint16_t port_of(int listening_socket);

/// Tests for an address that only this machine can reach.
bool is_loopback(std::string_view host);

/// Numeric address of the other end of a connection, "" if it has none.
std::string peer_of(int connected_socket);

} // namespace macadam
