#include "support/roads/cell_world.hpp"

#include "mapping/network/build_network.hpp"
#include "storage/postgres/server_connection.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/importer/server_importer.hpp"

namespace macadam::testing {

RoadNetwork border_country() {
    constexpr double lat_deg = 46.073230625408644, lon_deg = 3 * 360.0 / 256;
    constexpr double high_deg = 200.2 / 111'195, wide_deg = high_deg / 0.693;
    const auto at = [&](double x, double y) {
        return GeoPoint{lat_deg + y * high_deg, lon_deg + x * wide_deg};
    };
    const std::vector<GeoPoint> corners{at(-1.5, -0.5),
                                        at(-0.5, -0.5),
                                        at(0.5, -0.5),
                                        at(1.5, -0.5),
                                        at(1.5, 0.5),
                                        at(0.5, 0.5),
                                        at(-0.5, 0.5),
                                        at(-1.5, 0.5)};
    std::vector<Way> roads;
    for (std::int64_t number = 1; number <= border_ways; ++number) {
        const auto first = corners.begin() + (number - 1);
        Way way{.id = number,
                .name = "",
                .highway = "residential",
                .node_ids = {number, number + 1},
                .line = {first[0], first[1]}};
        roads.push_back(way);
    }
    return build_network(std::move(roads), 20);
}

BorderTrip::BorderTrip(int number) : record{RichTrip{number}.record} {
    const RichTrip one{number};
    for (std::int64_t way = 1; way <= border_ways; ++way) {
        for (auto pass : one.passes) {
            pass.segment.way_id = way;
            passes.push_back(pass);
        }
        for (auto trace : one.traces) {
            trace.chunk.way_id = way;
            traces.push_back(trace);
        }
        for (auto event : one.events) {
            event.segment.way_id = way;
            events.push_back(event);
        }
    }
}

bool add_border_trip(ImportTarget& trips, int number) {
    const BorderTrip trip{number};
    const auto one = trip.as_new();
    return trips.add_trips({&one, 1}).front();
}

void import_border_trips(const RoadStore& file, int first, int past) {
    const auto open = import_store_of(file);
    for (int number = first; number < past; ++number) {
        add_border_trip(*open.trips, number);
    }
    fuse_all(*open.trips);
}

void CellWorld::SetUp() {
    static_cast<void>(RoadStore::create(folder_ / "roads.gpkg", border_country(), settings()));
    ServerConnection boss{boss_};
    boss.run("CREATE ROLE macadam_operator; CREATE ROLE chief LOGIN IN ROLE macadam_operator");
    copy_to_server(folder_ / "roads.gpkg", front_, {}, {});
    for (const auto& cell : cells_of(boss)) {
        numbers_.push_back(cell.number);
    }
    ASSERT_EQ(numbers_.size(), 4U);
}

std::string CellWorld::digest_of_file(int trips) {
    auto store = RoadStore::create(folder_ / "file.gpkg", border_country(), settings());
    import_border_trips(store, 0, trips);
    return store.digest();
}

std::string CellWorld::digest() const {
    return StoreReader{open_server_reader(front_, {}, Audience::operator_, {}, {})}.digest();
}

std::int64_t CellWorld::move(std::size_t cell, const std::string& to) {
    ServerConnection boss{boss_};
    return move_cell(boss, numbers_.at(cell), to);
}

void CellWorld::spread() {
    for (std::size_t cell = 0; cell < numbers_.size(); ++cell) {
        move(cell, cell % 2 == 0 ? west_ : east_);
    }
}

void CellWorld::import(int first, int past) {
    const auto open = open_server_import(front_);
    for (int number = first; number < past; ++number) {
        EXPECT_TRUE(add_border_trip(*open.trips, number));
    }
    fuse_all(*open.trips);
}

std::int64_t CellWorld::number(const std::string& address, const std::string& sql) {
    return ServerConnection{address}.number(sql);
}

} // namespace macadam::testing
