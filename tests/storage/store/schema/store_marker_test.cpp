#include "storage/store/schema/store_marker.hpp"

#include "storage/exports/export.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "support/files/files.hpp"
#include "support/roads/old_store.hpp"
#include "support/roads/store_world.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

TEST(IsStore, HoldsForDatabasesThatCannotBeOpened) {
    const auto folder = test_folder();
    EXPECT_TRUE(is_store(put_store_of_version_2(folder)));

    new_store(folder / "a.gpkg");
    EXPECT_TRUE(is_store(folder / "a.gpkg"));
    std::ofstream{folder / "a.gpkg.key"} << "no key";
    EXPECT_TRUE(is_store(folder / "a.gpkg"));
    Database{folder / "a.gpkg", Database::Access::write}.run("DROP TABLE segment_dirty");
    EXPECT_TRUE(is_store(folder / "a.gpkg"));
}

TEST(IsStore, DoesNotHoldForOtherFiles) {
    const auto folder = test_folder();
    EXPECT_FALSE(is_store(folder));
    EXPECT_FALSE(is_store(folder / "missing.gpkg"));

    std::ofstream{folder / "text.gpkg"} << "macadam-store";
    EXPECT_FALSE(is_store(folder / "text.gpkg"));

    auto store = new_store(folder / "a.gpkg");
    import_trips(store, 1);
    export_segments(store, {}, folder / "exported.gpkg");
    EXPECT_FALSE(is_store(folder / "exported.gpkg"));
    Database{folder / "exported.gpkg", Database::Access::write}.run(
        "CREATE VIEW meta AS SELECT 'format' AS key, 'macadam-store' AS value");
    EXPECT_FALSE(is_store(folder / "exported.gpkg"));
}

} // namespace
} // namespace macadam::testing
