// Maps and other files made by somebody else do no more than be refused: no code of theirs runs, no
// server is asked, no file is opened that they name. strace watches.

#include "support/files/hostile_maps.hpp"
#include "support/program/places.hpp"
#include "support/program/program.hpp"
#include "support/program/traced_program.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::IsEmpty;

/// A port of this machine that counts who calls, where there is no network namespace.
class Listener {
public:
    Listener() : socket_{::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0)} {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        auto* const any = reinterpret_cast<sockaddr*>(&address);
        socklen_t size = sizeof address;
        EXPECT_EQ(::bind(socket_, any, size), 0);
        EXPECT_EQ(::listen(socket_, 8), 0);
        EXPECT_EQ(::getsockname(socket_, any, &size), 0);
        port_ = ntohs(address.sin_port);
    }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    ~Listener() { ::close(socket_); }

    std::string url() const { return fmt::format("http://127.0.0.1:{}/map", port_); }
    bool was_called() const { return ::accept(socket_, nullptr, nullptr) >= 0; }

private:
    int socket_;
    int port_ = 0;
};

class HostileMaps : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        const auto elsewhere = fs::path{folder_.string() + "_elsewhere"};
        fs::create_directories(elsewhere);
        write_file(elsewhere / "bait.txt", "root:x:0:0\n");
        baits_ = {elsewhere / "bait.txt", listener_.url()};
    }

    void TearDown() override {
        EXPECT_FALSE(listener_.was_called());
        for (const auto& each : fs::recursive_directory_iterator{folder_}) {
            EXPECT_NE(each.path().filename(), "CODE_RAN") << each.path();
        }
    }

    /// What the program's own readers take of these files, in one process.
    Traced opened(const std::vector<std::string>& names) const {
        std::ofstream list{folder_ / "list.txt"};
        for (const auto& name : names) {
            list << name << '\n';
        }
        list.close();
        return run_traced(MACADAM_OPEN_MAPS, {(folder_ / "list.txt").string()}, folder_);
    }

    static std::vector<std::string> names_of(const std::vector<fs::path>& files) {
        return {files.begin(), files.end()};
    }

    fs::path folder_;
    Baits baits_;
    Listener listener_;
};

TEST_F(HostileMaps, LeadToNoCodeNoServerAndNoOtherFile) {
    const auto maps = write_hostile_maps(folder_ / "maps", baits_, MACADAM_EVIL_LIBRARY);
    const auto run = opened(names_of(maps));
    EXPECT_EQ(run.exit_status, 0) << run.said;
    EXPECT_THAT(run.breaches, IsEmpty());
    // Whole maps that name what is hostile: they are read without it.
    EXPECT_EQ(run.said,
              "network table.shp\n"
              "base map whole.tif\n"
              "base map overview.tif\n"
              "base map mask.tif\n"
              "network crs_link.geojson\n"
              "network crs_url.geojson\n"
              "network crs_file.geojson\n"
              "network schema_url.gml\n"
              "network schema_file.gml\n"
              "network system_url.gml\n"
              "network system_file.gml\n"
              "network link.kml\n");
}

TEST_F(HostileMaps, OfEachDriverLeadToNoCodeNoServerAndNoOtherFile) {
    const auto maps = write_generated_maps(folder_ / "maps", baits_);
    EXPECT_GT(maps.size(), 600U);
    const auto run = opened(names_of(maps));
    EXPECT_EQ(run.exit_status, 0) << run.said;
    EXPECT_THAT(run.breaches, IsEmpty());
    EXPECT_EQ(run.said, "");
}

TEST_F(HostileMaps, AreNoConnectionStrings) {
    fs::create_directories(folder_ / "maps");
    const auto run = opened(connection_strings(folder_ / "maps", baits_));
    EXPECT_EQ(run.exit_status, 0) << run.said;
    EXPECT_THAT(run.breaches, IsEmpty());
    EXPECT_EQ(run.said, "");
}

/// The program itself, by every option that takes a file of others.
TEST_F(HostileMaps, AreNotFollowedByAnyCommandThatReadsFiles) {
    write_hostile_maps(folder_ / "maps", baits_, MACADAM_EVIL_LIBRARY);
    const auto store = (folder_ / "roads.gpkg").string();
    {
        auto roads = new_store(store);
        import_trips(roads, 6);
    }
    const std::string trip = source_folder() + "/sample_data/gyor/gyor_q3_00.trip.csv";
    const auto map = [&](const char* name) { return (folder_ / "maps" / name).string(); };
    const auto out = (folder_ / "out").string();
    const std::vector<std::vector<std::string>> commands{
        {"render", store, "-o", out + ".png", "--base", map("aerial.tif")},
        {"render", store, "-o", out + ".png", "--base", map("raw.vrt")},
        {"render", store, "-o", out + ".png", "--style", map("aerial.tif")},
        {"init", out + ".gpkg", "--network", map("roads.sqlite")},
        {"init", out + ".gpkg", "--network", map("roads_wfs.sqlite")},
        {"query", store, "--sections", map("roads.gpkg")},
        {"export", store, "-o", out + ".geojson", "--sections", map("roads.sqlite")},
        {"report",
         store,
         "-o",
         out + ".html",
         "--sections",
         map("plain.geojson"),
         "--exclude",
         map("layer.vrt")},
        {"match", trip, "--network", map("roads.sqlite")},
        {"import", store, map("aerial.tif")},
        {"import", store, map("packed.zip")},
        {"import", store, "--reference", map("roads.sqlite")},
        {"import", store, "--control", map("aerial.tif")},
        {"trace", trip, "--vehicle", map("aerial.tif")},
        {"trace", trip, "--mapping", map("aerial.tif")},
        {"iri", map("aerial.tif")},
        {"identify", trip, "--profile", map("aerial.tif")},
        {"simulate", "-o", out, "--recipe", map("aerial.tif"), "--network", map("roads.gpkg")}};
    for (const auto& words : commands) {
        const auto run =
            run_traced(program_file(), words, folder_, {fs::path{source_folder()} / "sample_data"});
        EXPECT_THAT(run.exit_status, ::testing::AnyOf(1, 2)) << words[0] << ": " << run.said;
        EXPECT_THAT(run.breaches, IsEmpty()) << words[0] << ' ' << words.back();
    }
}

} // namespace
} // namespace macadam::testing
