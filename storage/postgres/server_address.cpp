#include "storage/postgres/server_address.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>
#include <libpq-fe.h>

#include <cctype>
#include <memory>
#include <string_view>

namespace macadam {

bool is_server_address(std::string_view database) {
    return database.starts_with("postgresql://") || database.starts_with("postgres://");
}

void expect_address_without_secrets(const std::string& address) {
    static_cast<void>(connection_settings(address));
}

ConnectionSettings connection_settings(const std::string& address) {
    struct Free {
        void operator()(PQconninfoOption* options) const { PQconninfoFree(options); }
    };
    char* error = nullptr; // may repeat the address
    const std::unique_ptr<PQconninfoOption, Free> options{PQconninfoParse(address.c_str(), &error)};
    PQfreemem(error);
    if (!options) {
        throw InputError{"the address of the database is malformed, expected "
                         "postgresql://USER@HOST:PORT/DATABASE"};
    }
    ConnectionSettings settings;
    for (const auto* option = options.get(); option->keyword != nullptr; ++option) {
        const std::string_view keyword{option->keyword};
        if (option->val == nullptr || *option->val == '\0') {
            continue;
        }
        if (keyword == "password" || keyword == "sslpassword") {
            throw InputError{"the address of the database holds a password, which others see in "
                             "the list of processes; expected it in the file ~/.pgpass (mode "
                             "0600) or in PGPASSWORD"};
        }
        settings.emplace(keyword, option->val);
    }
    return settings;
}

std::string database_name(const std::string& address) {
    auto settings = connection_settings(address);
    std::string name;
    for (const char c : settings["dbname"]) {
        const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' ||
                              (c == '-' && !name.empty());
        name += is_plain ? c : '_';
    }
    return name.empty() ? "roads" : name;
}

void expect_file(std::string_view database) {
    if (is_server_address(database)) {
        throw InputError{fmt::format("{0}: this command works on a GeoPackage file only so far: "
                                     "'macadam copy {0} roads.gpkg' makes one",
                                     database)};
    }
}

} // namespace macadam
