#pragma once

#include "support/http/http_client.hpp"
#include "support/program/piped_program.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace macadam::testing {

std::string sha256_of(std::string_view bytes);
std::string target_of(std::string_view log);

/// `macadam serve` of a database on PostgreSQL, and what clients send to it. Waits while a busy
/// machine keeps it from answering.
class UploadServer {
public:
    /// \param address  of the database
    explicit UploadServer(std::string address) : address_{std::move(address)} {}

    /// Starts it, and waits until it answers.
    void start();

    /// Ends it at once, as the machine may.
    void kill();

    /// Creates a token of the database.
    std::string token(const std::string& owner, const std::string& scope) const;

    /// Asks, and again while the server cannot check tokens.
    Answer ask(std::string_view method,
               std::string_view target,
               std::string_view token,
               std::string_view body = {}) const;

    Answer put(std::string_view log, std::string_view token) const;

    /// Asks until the answer has a status.
    bool await(std::string_view target, std::string_view token, int status) const;

    std::string state(std::string_view log, std::string_view token) const;

    std::uint16_t port() const { return port_; }

private:
    std::string address_;
    std::uint16_t port_ = quiet_port();
    std::unique_ptr<PipedProgram> program_;
};

} // namespace macadam::testing
