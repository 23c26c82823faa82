#pragma once

#include "storage/store/server/cells/cell_moves.hpp"
#include "storage/store/server/reader/server_reader.hpp"
#include "support/files/files.hpp"
#include "support/program/postgres_server.hpp"
#include "support/roads/engine_world.hpp"
#include "support/roads/store_world.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace macadam::testing {

// A database whose cells lie on two servers, with roads across their border.

inline constexpr std::int64_t border_ways = 7;

/// Seven roads of 200 m in a row around the corner of four map tiles of zoom 8, three of them
/// across a border:
///
///     8--7 : 6--5
///     ... .:... |
///     1--2-:-3--4
RoadNetwork border_country();

/// Trip over all roads, there and back.
struct BorderTrip {
    explicit BorderTrip(int number);
    NewTrip as_new() const { return {&record, passes, traces, false, events}; }

    TripRecord record;
    std::vector<Pass> passes;
    std::vector<RoughnessTrace> traces;
    std::vector<PassEvent> events;
};

bool add_border_trip(ImportTarget& trips, int number);

/// Adds trips to a file and fuses them.
void import_border_trips(const RoadStore& file, int first, int past);

/// Front with two servers for its cells.
class CellWorld : public ::testing::Test {
protected:
    void SetUp() override;

    std::string digest_of_file(int trips);

    std::string digest() const;

    std::int64_t move(std::size_t cell, const std::string& to);

    /// Moves the western cells to one server, the eastern ones to the other.
    void spread();

    void import(int first, int past);

    static std::int64_t number(const std::string& address, const std::string& sql);

    /// The address as clients of a cluster have it, whose first server is down.
    static std::string with_a_standby(std::string address) {
        return address.replace(
            address.find("?host="), 6, "?target_session_attrs=read-write&host=/nowhere,");
    }

    std::filesystem::path folder_ = test_folder();
    PostgresServer east_server_;
    PostgresServer server_; // keys and roads are kept there
    std::string front_ = server_.new_database("front");
    std::string boss_ = server_.address("front");
    std::string chief_ = server_.address("front", "chief"); ///< only a member of macadam_operator
    std::string west_ = with_a_standby(server_.new_database("west"));
    std::string east_ = east_server_.new_database("east");
    std::vector<std::int32_t> numbers_; ///< north-west, north-east, south-west, south-east
};

} // namespace macadam::testing
