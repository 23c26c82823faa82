#include "mapping/background/background_levels.hpp"
#include "mapping/background/background_pieces.hpp"
#include "storage/store/put_background.hpp"
#include "storage/store/reader/store_background.hpp"
#include "storage/store/road_store.hpp"
#include "storage/store/upgrade/store_upgrade.hpp"

#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <set>

namespace macadam {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using testing::import_trips;
using ::testing::IsEmpty;
using testing::new_store;
using testing::refusal_of;
using ::testing::SizeIs;
using testing::small_country;
using testing::test_folder;

/// A square of some side around the country's first point, in degrees.
BackgroundFeature square(BackgroundKind kind, double side_deg) {
    const auto box = extent_of(small_country());
    const auto corner = [&](double north, double east) {
        return packed({box.south_deg + north * side_deg, box.west_deg + east * side_deg});
    };
    return {kind, {{corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}}};
}

BackgroundSource background() {
    return [](const BackgroundSink& sink) {
        const auto box = extent_of(small_country());
        sink.feature(square(BackgroundKind::forest, 0.02));
        sink.feature(square(BackgroundKind::building, 0.0002));
        sink.place({"Afar", PlaceRank::town, {box.south_deg + 0.5, box.west_deg}});
        sink.place({"Smallham", PlaceRank::village, {box.south_deg, box.west_deg}, 30});
        sink.place({"Bigham", PlaceRank::village, {box.south_deg, box.west_deg}, 900});
        sink.place({"Town", PlaceRank::town, {box.south_deg, box.west_deg}});
        sink.road_ref({1, "D 12"});
        sink.road_ref({77, "A 1"}); // a way that is not in the network
    };
}

GeoBox box_of_country() {
    return background_box(small_country());
}

StoreBackground store_with_background(const std::filesystem::path& file) {
    new_store(file);
    put_background(file, box_of_country(), background());
    return StoreBackground{StoreReader::open(file)};
}

std::set<BackgroundKind> kinds_at(const StoreBackground& store, const BackgroundLevel& level) {
    std::set<BackgroundKind> kinds;
    for (const auto& tile : store.tiles(level, box_of_country())) {
        visit_pieces(tile.pieces, [&](const BackgroundPiece& piece) { kinds.insert(piece.kind); });
    }
    return kinds;
}

TEST(StoreBackground, IsReadByLevelAndBox) {
    const auto store = store_with_background(test_folder() / "a.gpkg");
    EXPECT_THAT(kinds_at(store, background_levels[0]),
                ElementsAre(BackgroundKind::forest, BackgroundKind::building));
    EXPECT_THAT(kinds_at(store, background_levels[1]), ElementsAre(BackgroundKind::forest));
    constexpr GeoBox elsewhere{.west_deg = 50, .south_deg = 10, .east_deg = 51, .north_deg = 11};
    EXPECT_THAT(store.tiles(background_levels[0], elsewhere), IsEmpty());
    EXPECT_GT(store.size().bytes, 0);
}

TEST(StoreBackground, NamesThePlacesOnAMapByImportance) {
    const auto store = store_with_background(test_folder() / "a.gpkg");
    EXPECT_THAT(store.places(box_of_country()),
                ElementsAre(Field(&PlaceName::name, "Town"),
                            Field(&PlaceName::name, "Bigham"),
                            Field(&PlaceName::name, "Smallham")));
}

TEST(StoreBackground, KeepsNumbersOfItsOwnRoadsAlone) {
    const auto roads = store_with_background(test_folder() / "a.gpkg").road_refs();
    ASSERT_THAT(roads, SizeIs(1));
    EXPECT_EQ(roads[0].way_id, 1);
    EXPECT_EQ(roads[0].ref, "D 12");
}

TEST(StoreBackground, IsNoPartOfTheDigest) {
    const auto file = test_folder() / "a.gpkg";
    auto store = new_store(file);
    import_trips(store, 2);
    const auto digest = store.digest();
    put_background(file, box_of_country(), background());
    EXPECT_FALSE(StoreBackground{StoreReader::open(file)}.size().is_empty());
    EXPECT_EQ(store.digest(), digest);
}

TEST(StoreBackground, IsReplacedAndRemoved) {
    const auto file = test_folder() / "a.gpkg";
    store_with_background(file);
    put_background(file, box_of_country(), [](const BackgroundSink& sink) {
        sink.feature(square(BackgroundKind::water, 0.02));
    });
    const StoreBackground store{StoreReader::open(file)};
    EXPECT_THAT(kinds_at(store, background_levels[0]), ElementsAre(BackgroundKind::water));
    EXPECT_THAT(store.places(box_of_country()), IsEmpty());
    put_background(file, box_of_country(), {});
    EXPECT_TRUE(store.size().is_empty());
}

TEST(StoreBackground, IsNoticedWhenItChangesAlsoByReadersOfPublications) {
    for (const auto privacy : {PrivacyProfile::own, PrivacyProfile::crowd}) {
        const auto file = test_folder() / fmt::format("{}.gpkg", name_of(privacy));
        auto config = testing::settings();
        config.privacy = privacy;
        RoadStore::create(file, small_country(), config, {});
        const auto reader = StoreReader::open(file);
        const auto before = reader.moment();
        EXPECT_TRUE(reader.changed_since(before));
        put_background(file, box_of_country(), background(), "town.osm");
        EXPECT_FALSE(reader.changed_since(before)) << name_of(privacy);
    }
}

TEST(StoreBackground, StaysAsItWasWhereTheNewOneCannotBeRead) {
    const auto file = test_folder() / "a.gpkg";
    const auto store = store_with_background(file);
    const auto bytes = store.size().bytes;
    EXPECT_THAT(refusal_of([&] {
                    put_background(file, box_of_country(), [](const BackgroundSink& sink) {
                        sink.feature(square(BackgroundKind::water, 0.02));
                        throw InputError{"the map is torn"};
                    });
                }),
                HasSubstr("the map is torn"));
    EXPECT_EQ(store.size().bytes, bytes);
}

TEST(StoreBackground, OfADatabaseOfVersion5IsEmptyUntilItIsPut) {
    const auto file = test_folder() / "a.gpkg";
    std::string digest;
    {
        auto store = new_store(file);
        import_trips(store, 2);
        digest = store.digest();
    }
    {
        Database database{file, Database::Access::write};
        database.run("DROP TABLE background; DROP TABLE place; DROP TABLE road_ref;"
                     "DELETE FROM gpkg_extensions WHERE table_name IN"
                     " ('background', 'place', 'road_ref');"
                     "DELETE FROM gpkg_contents WHERE table_name IN"
                     " ('background', 'place', 'road_ref');"
                     "ALTER TABLE trip DROP COLUMN trimmed_mm;"
                     "UPDATE meta SET value = '5' WHERE key = 'version'");
    }
    EXPECT_THAT(refusal_of([&] { StoreReader::open(file); }),
                HasSubstr("is a database of version 5, expected version 7: run 'macadam upgrade"));
    const auto done = upgrade_store(file, {}, [](auto) { return Progress{}; });
    EXPECT_EQ(done.from_version, 5);
    EXPECT_EQ(done.to_version, 7);
    EXPECT_EQ(done.digest, digest);
    Database database{file, Database::Access::read};
    EXPECT_EQ(database.number("SELECT count(*) - count(DISTINCT table_name) FROM gpkg_extensions"
                              " WHERE extension_name = 'macadam_inner_table'"),
              0);
    EXPECT_TRUE(StoreBackground{StoreReader::open(file)}.size().is_empty());
    put_background(file, box_of_country(), background());
    EXPECT_FALSE(StoreBackground{StoreReader::open(file)}.size().is_empty());
}

TEST(StoreBackground, ThatWasModifiedIsRefused) {
    const auto file = test_folder() / "a.gpkg";
    store_with_background(file);
    Database{file, Database::Access::write}.run("UPDATE place SET rank = 9");
    const StoreBackground store{StoreReader::open(file)};
    EXPECT_THAT(refusal_of([&] { store.places(box_of_country()); }),
                HasSubstr("a.gpkg: a place has rank 9; the database was modified by another "
                          "program"));
}

} // namespace
} // namespace macadam
