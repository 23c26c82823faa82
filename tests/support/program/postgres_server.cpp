#include "support/program/postgres_server.hpp"

#include "support/program/shell.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>
#include <system_error>

#include <unistd.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

/// Newest server that Debian installed.
fs::path server_programs() {
    fs::path newest;
    for (const auto& version : fs::directory_iterator{"/usr/lib/postgresql"}) {
        if (fs::exists(version.path() / "bin/postgres") && version.path() > newest) {
            newest = version.path();
        }
    }
    return newest / "bin";
}

/// PostgreSQL refuses to run as root.
std::string as_ordinary_user() {
    return geteuid() == 0 ? "setpriv --reuid=nobody --regid=nogroup --clear-groups " : "";
}

void expect_success(const fs::path& folder, const std::string& command) {
    const auto output = output_of(folder, command);
    if (output.find("\nexit ") != std::string::npos) {
        throw std::runtime_error{command + ": " + output};
    }
}

/// Creates a folder for whoever runs the server.
fs::path new_folder() {
    std::string name = "/tmp/macadam-pg-XXXXXX"; // paths of sockets have at most 107 bytes
    if (mkdtemp(name.data()) == nullptr) {
        throw std::runtime_error{"cannot create " + name};
    }
    if (geteuid() == 0) {
        expect_success(name, fmt::format("chown nobody:nogroup {}", name));
    }
    return name;
}

/// Data of a server that never ran, made once for all servers of the process.
class FreshData {
public:
    FreshData() : folder_{new_folder()} {
        expect_success(folder_,
                       fmt::format("cd / && {} {}/initdb -D {} -U boss -A trust -E UTF8"
                                   " --locale=C.UTF-8 --no-sync --no-instructions",
                                   as_ordinary_user(),
                                   server_programs().string(),
                                   path().string()));
    }
    FreshData(const FreshData&) = delete;
    FreshData& operator=(const FreshData&) = delete;
    ~FreshData() {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }

    fs::path path() const { return folder_ / "data"; }

private:
    fs::path folder_;
};

void copy_fresh_data(const fs::path& to) {
    static const FreshData fresh;
    expect_success(
        to.parent_path(),
        fmt::format(
            "cd / && {} cp -r {} {}", as_ordinary_user(), fresh.path().string(), to.string()));
}

} // namespace

PostgresServer::PostgresServer(std::chrono::seconds most) : folder_{new_folder()}, most_{most} {
    // Where the program keeps keys and roads of databases on servers.
    setenv("XDG_CONFIG_HOME", (folder_ / "config").c_str(), 1); // NOLINT(concurrency-mt-unsafe)
    setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);   // NOLINT(concurrency-mt-unsafe)
    copy_fresh_data(folder_ / "data");
    start();
}

void PostgresServer::start() {
    const auto programs = server_programs().string();
    const auto name = folder_.string();
    expect_success(
        folder_,
        fmt::format("(cd / && unset PGHOST PGUSER PGDATABASE PGPASSWORD; {} timeout -k 5 {}"
                    " {}/postgres -D {}/data -c listen_addresses="
                    " -c unix_socket_directories={} -c fsync=off -c autovacuum=off"
                    " >/dev/null 2>&1 </dev/null &)",
                    as_ordinary_user(),
                    most_.count(),
                    programs,
                    name,
                    name));
    expect_success(folder_,
                   fmt::format("(for i in $(seq 600); do {}/pg_isready -q -h {} && exit 0;"
                               " sleep 0.1; done; exit 1)",
                               programs,
                               name));
}

void PostgresServer::kill_and_restart() {
    // The workers first: while one of them has the memory of all, another server is not let in.
    expect_success(folder_,
                   fmt::format("first=$(head -1 {0}/data/postmaster.pid); kill -STOP $first;"
                               " all=\"$(ps -o pid= --ppid $first) $first\"; kill -KILL $all;"
                               " while ps -o stat= -p \"$(echo $all | tr ' ' ,)\" | grep -qv ^Z;"
                               " do sleep 0.02; done;"
                               " rm -f {0}/data/postmaster.pid {0}/.s.PGSQL.5432*",
                               folder_.string()));
    start();
}

PostgresServer::~PostgresServer() {
    output_of(folder_,
              fmt::format("kill -QUIT $(head -1 {0}/data/postmaster.pid); for i in $(seq 100); do"
                          " [ -e {0}/.s.PGSQL.5432.lock ] || break; sleep 0.05; done",
                          folder_.string()));
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

std::string PostgresServer::address(const std::string& database, const std::string& role) const {
    return fmt::format("postgresql://{}@/{}?host={}", role, database, folder_.string());
}

std::string PostgresServer::new_database(const std::string& name) {
    const auto psql = fmt::format(
        "{}/psql -qX -v ON_ERROR_STOP=1 '{}' -c ", server_programs().string(), address());
    output_of(folder_, psql + "'CREATE ROLE owner LOGIN'"); // exists from the second database on
    expect_success(folder_, psql + fmt::format("'CREATE DATABASE {} OWNER owner'", name));
    expect_success(folder_,
                   fmt::format("{}/psql -qX -v ON_ERROR_STOP=1 '{}' -c 'CREATE EXTENSION postgis'",
                               server_programs().string(),
                               address(name)));
    return address(name, "owner");
}

} // namespace macadam::testing
