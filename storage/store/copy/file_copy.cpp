#include "storage/store/copy/file_copy.hpp"

#include "estimator/common/error.hpp"
#include "storage/store/rows/store_digest.hpp"

#include <fmt/format.h>

#include <system_error>

namespace macadam {

std::shared_ptr<StoreConnection> open_original(const std::filesystem::path& file,
                                               const LockWaitPolicy& wait_policy) {
    auto store = open_connection(file, Database::Access::read, wait_policy, Audience::operator_);
    if (store->published_alone) {
        throw InputError{fmt::format("{}: is of a crowd, and its key is not at {}, expected it "
                                     "there: trips of a crowd are for its operator only",
                                     file.string(),
                                     store->key_file.string())};
    }
    return store;
}

void expect_new_file(const std::filesystem::path& file) {
    std::error_code none;
    if (std::filesystem::exists(std::filesystem::symlink_status(file, none))) {
        throw InputError{
            fmt::format("{}: already exists, expected the name of a new file", file.string())};
    }
}

void expect_same_digest(const std::string& copied,
                        const std::string& original,
                        const std::string& copy) {
    if (copied != original) {
        throw InputError{
            fmt::format("{}: the copy has the digest {}, expected {}; nothing was written",
                        copy,
                        copied,
                        original)};
    }
}

StoreCopy finish_copy(Database& database,
                      AtomicFileSet& whole,
                      const std::string& original,
                      const std::optional<PrivacyKey>& key,
                      const Progress& progress) {
    const auto file = database.file();
    StoreCopy copy{.trips = static_cast<std::size_t>(database.number("SELECT count(*) FROM trip")),
                   .passes = static_cast<std::size_t>(database.number("SELECT count(*) FROM pass")),
                   .digest = digest_of(database, {.report = {}, .stop = progress.stop}),
                   .key_file = key_file_of(file)};
    expect_same_digest(copy.digest, original, file.string());
    database.close();
    remove_leftovers_of(file);
    whole.commit_new();
    if (key && !read_key(copy.key_file)) {
        write_key(copy.key_file, *key);
    }
    return copy;
}

} // namespace macadam
