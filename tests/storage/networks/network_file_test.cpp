#include "mapping/network/build_network.hpp"
#include "storage/networks/network_file.hpp"

#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

using namespace macadam;
using namespace macadam::testing;
using ::testing::EndsWith;
using ::testing::HasSubstr;

namespace {

const std::string source(64, '7');

std::string content_of(const std::filesystem::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

std::string refusal_of_file(const std::string& content) {
    const auto file = written(test_folder(), "roads-network", content);
    return refusal_of([&] { open_network_file(file); });
}

std::string whole_file() {
    const auto file = test_folder() / "whole";
    write_network_file(small_country(), source, file);
    return content_of(file);
}

} // namespace

TEST(NetworkFile, IsReadBackAsTheSameNetwork) {
    const auto folder = test_folder();
    write_network_file(small_country(), source, folder / "a");
    const auto opened = open_network_file(folder / "a");
    EXPECT_EQ(opened.source, source);
    EXPECT_EQ(opened.roads.segment_length_m, 20);
    write_network_file(opened.roads, source, folder / "b");
    EXPECT_EQ(content_of(folder / "a"), content_of(folder / "b"));
    EXPECT_TRUE(is_network_file(folder / "a"));
}

TEST(NetworkFile, StaysOpenWhenItsNameIsGivenToAnother) {
    const auto file = test_folder() / "a";
    write_network_file(small_country(), source, file);
    const auto opened = open_network_file(file);
    write_network_file(build_network({}), source, file);
    EXPECT_EQ(link_count(opened.roads), link_count(small_country()));
    EXPECT_EQ(link_count(open_network_file(file).roads), 0U);
}

TEST(NetworkFile, ThatIsNoneIsRefused) {
    EXPECT_THAT(refusal_of_file("way,name\n1,Rue\n"), EndsWith("is not a Macadam network file"));
    EXPECT_THAT(refusal_of_file(""), EndsWith("is not a Macadam network file"));
    EXPECT_THAT(refusal_of([] { open_network_file(test_folder() / "none"); }),
                EndsWith("none: cannot be read: No such file or directory"));
    EXPECT_THAT(refusal_of([] { open_network_file(test_folder()); }), EndsWith("is not a file"));
    EXPECT_FALSE(is_network_file(test_folder() / "none"));
    EXPECT_FALSE(is_network_file(test_folder()));
}

TEST(NetworkFile, ThatWasCutOrChangedIsRefused) {
    const auto whole = whole_file();
    EXPECT_THAT(refusal_of_file(whole.substr(0, whole.size() / 2)), HasSubstr("it is truncated"));
    auto changed = whole;
    changed[changed.size() / 2] ^= 4;
    EXPECT_THAT(refusal_of_file(changed), HasSubstr("is damaged: "));
}

TEST(KeptRoads, AreThoseOfTheStoreWithItsFileAndWithout) {
    const auto folder = test_folder();
    const auto store = new_store(folder / "a.gpkg");
    const auto built = load_or_build_network(store);
    ASSERT_TRUE(std::filesystem::exists(folder / "a.gpkg-network"));
    const auto mapped = load_or_build_network(store);
    for (const auto& roads : {built, mapped}) {
        write_network_file(roads, source, folder / "as-it-is");
        write_network_file(small_country(), source, folder / "as-made");
        EXPECT_EQ(content_of(folder / "as-it-is"), content_of(folder / "as-made"));
    }
}

TEST(KeptRoads, AreMadeAgainWhereTheFileIsDamagedOrAnothers) {
    const auto folder = test_folder();
    const auto store = new_store(folder / "a.gpkg");
    const auto beside = network_file_of(folder / "a.gpkg");
    load_or_build_network(store);
    const auto right = content_of(beside);
    auto damaged = right;
    damaged[damaged.size() - 1] ^= 1;
    write_network_file(build_network({}), source, folder / "anothers");
    for (const auto& wrong :
         {damaged, right.substr(0, 200), content_of(folder / "anothers"), std::string{"hello"}}) {
        written(folder, "a.gpkg-network", wrong);
        EXPECT_EQ(link_count(load_or_build_network(store)), link_count(small_country()));
        EXPECT_EQ(content_of(beside), right);
    }
}

TEST(KeptRoads, AreHadWhereTheFileCannotBeWritten) {
    const auto folder = test_folder();
    const auto store = new_store(folder / "a.gpkg");
    std::filesystem::create_directory(network_file_of(folder / "a.gpkg"));
    EXPECT_EQ(link_count(load_or_build_network(store)), link_count(small_country()));
    EXPECT_FALSE(cache_network(store, small_country()));
}

TEST(KeptRoads, AreFoundByWhatTheyAreMadeOf) {
    const auto folder = test_folder();
    auto ways = copies_of_ways(small_country());
    const auto hash_with = [&](const char* name) {
        return RoadStore::create(folder / name, build_network(ways, 20), settings()).network_hash();
    };
    const auto first = hash_with("a.gpkg");
    EXPECT_EQ(hash_with("b.gpkg"), first);
    ways[0].turns = {{ways[0].node_ids.back(), 2, 0}};
    const auto with_turn = hash_with("c.gpkg");
    EXPECT_NE(with_turn, first);
    ways[1].speed_limit_cmps = 1111;
    const auto with_limit = hash_with("d.gpkg");
    EXPECT_NE(with_limit, with_turn);
    ways[0].line[1].lat_deg += 1e-6;
    EXPECT_NE(hash_with("e.gpkg"), with_limit);
}
