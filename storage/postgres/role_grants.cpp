#include "storage/postgres/role_grants.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

/// \param chosen  gives names of roles
std::string granting_to(std::string_view rights, std::string_view chosen) {
    return fmt::format(R"(
DO $$
DECLARE
    role text;
BEGIN
    FOR role IN {} LOOP
        EXECUTE format('GRANT {} TO %I', role);
    END LOOP;
END $$;
)",
                       chosen,
                       rights);
}

} // namespace

std::string granting(std::string_view rights, std::initializer_list<std::string_view> roles) {
    return granting_to(rights,
                       fmt::format("SELECT rolname FROM pg_roles WHERE rolname IN ('{}')",
                                   fmt::join(roles, "', '")));
}

std::string granting_to_owner(std::string_view rights) {
    return granting_to(rights,
                       "SELECT rolname FROM pg_roles JOIN pg_namespace ON nspowner = pg_roles.oid"
                       " WHERE nspname = 'macadam'");
}

} // namespace macadam
