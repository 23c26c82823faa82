#include "old_store.hpp"
#include "support/program/places.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace macadam::testing {

std::filesystem::path put_store_of_version_2(const std::filesystem::path& folder,
                                             const std::string& name) {
    const auto file = folder / name;
    for (const auto* const suffix : {"-wal", "-shm"}) { // of the file that it replaces
        std::filesystem::remove(file.string() + suffix);
    }
    const std::string packed = source_folder() + "/tests/data/stores/version-2.gpkg.gz";
    EXPECT_EQ(std::system(("gzip -dc '" + packed + "' > '" + file.string() + "'").c_str()), 0);
    return file;
}

} // namespace macadam::testing
