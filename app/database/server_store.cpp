#include "app/database/server_store.hpp"

#include "app/database/segment_options.hpp"

#include "estimator/common/error.hpp"
#include "storage/postgres/server_address.hpp"

namespace macadam {

std::filesystem::path file_or_server(const Arguments& arguments) {
    const auto& store = arguments.operand("STORE");
    if (!is_server_address(store)) {
        return store_file(arguments);
    }
    try {
        expect_address_without_secrets(store);
    } catch (const InputError& error) {
        throw UsageError{error.what()};
    }
    return store;
}

} // namespace macadam
