#pragma once

#include <chrono>
#include <filesystem>
#include <string>

namespace macadam::testing {

/// PostgreSQL server of an ordinary user, for one test: on a socket in a folder of its own, with a
/// superuser `boss`. It is stopped at the end of the test, and ends itself after 400 s. Keys and
/// roads of its databases are kept there too, by the variables of the environment.
class PostgresServer {
public:
    /// Starts it.
    /// \param most  time after which it ends itself
    /// \throws std::runtime_error  with what it says, if it does not start.
    explicit PostgresServer(std::chrono::seconds most = std::chrono::seconds{400});
    PostgresServer(const PostgresServer&) = delete;
    PostgresServer& operator=(const PostgresServer&) = delete;
    ~PostgresServer();

    /// Ends all of it at once, as a machine that fails does, and starts it again.
    void kill_and_restart();

    /// Address of a database for a role.
    std::string address(const std::string& database = "postgres",
                        const std::string& role = "boss") const;

    /// Creates an empty database with PostGIS, which belongs to role `owner` without further
    /// rights. \returns its address for that role.
    std::string new_database(const std::string& name);

private:
    void start();

    std::filesystem::path folder_;
    std::chrono::seconds most_;
};

} // namespace macadam::testing
