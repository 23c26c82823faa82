#include "fuzz/input_file.hpp"
#include "fuzz/rules.hpp"
#include "fuzz/targets.hpp"

#include "app/pipeline.hpp"
#include "mapping/trace_network.hpp"
#include "storage/foreign/trip_mapping.hpp"
#include "storage/mapping_file.hpp"
#include "storage/trip_feed.hpp"
#include "storage/trip_reader.hpp"
#include "storage/trip_writer.hpp"
#include "support/walked_trips.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace macadam::fuzz {
namespace {

void expect_rising(const std::vector<double>& t_s) {
    expect(std::ranges::adjacent_find(t_s, std::greater_equal{}) == t_s.end(), "times rise");
}

void expect_whole(const TriaxialSamples& samples) {
    const auto count = samples.t_s.size();
    expect(samples.x.size() == count && samples.y.size() == count && samples.z.size() == count,
           "every time has its readings");
    expect_rising(samples.t_s);
}

void expect_accounted(const TripLog& trip, const TripUse& use) {
    const auto rows = account(trip, use);
    expect(rows.read == trip.rows.size(), "every row is counted");
    expect(rows.read == rows.used + rows.rejected, "every row is either used or rejected");
}

void expect_sound(const TripLog& trip) {
    expect_whole(trip.acc);
    expect_whole(trip.gyro);
    expect(trip.speed.t_s.size() == trip.speed.speed_mps.size(), "every time has its speed");
    expect_rising(trip.speed.t_s);
    expect(std::ranges::adjacent_find(trip.fixes, std::greater_equal{}, &GnssFix::t_s) ==
               trip.fixes.end(),
           "fixes rise");
    expect_accounted(trip,
                     {.acc = std::vector<std::uint8_t>(trip.acc.t_s.size()),
                      .gyro = std::vector<std::uint8_t>(trip.gyro.t_s.size()),
                      .speed = std::vector<std::uint8_t>(trip.speed.t_s.size()),
                      .fixes = std::vector<std::uint8_t>(trip.fixes.size())});
}

/// Accepted if there is a trip, and each of them is.
Answer read_all(const testing::WalkedTrips& search) {
    auto answer = search.trips.empty() ? Answer::refused : Answer::accepted;
    for (const auto& source : search.trips) {
        answer =
            both(answer, may_refuse([&] { expect_sound(read_trip(source, needs_of_import())); }));
    }
    return answer;
}

/// The search, too, may refuse.
template <typename Search>
Answer read_all_of(Search search) {
    auto answer = Answer::refused;
    may_refuse([&] { answer = read_all(search()); });
    return answer;
}

/// A log has times to the microsecond; of two samples of a sensor in one, the later is lost. A fix
/// whose place is printed as 0, 0 is none.
bool can_be_told_apart(const TripLog& trip) {
    constexpr double least_s = 2e-6;
    const auto is_at_zero = [](const GnssFix& fix) {
        constexpr double printed_deg = 1e-8;
        return std::abs(fix.at.lat_deg) < printed_deg && std::abs(fix.at.lon_deg) < printed_deg;
    };
    if (std::ranges::any_of(trip.fixes, is_at_zero)) {
        return false;
    }
    const auto too_close = [](double a, double b) { return !(b - a >= least_s); };
    const auto are_apart = [&](const std::vector<double>& t_s) {
        return std::ranges::adjacent_find(t_s, too_close) == t_s.end();
    };
    return are_apart(trip.acc.t_s) && are_apart(trip.gyro.t_s) && are_apart(trip.speed.t_s) &&
           std::ranges::adjacent_find(trip.fixes, too_close, &GnssFix::t_s) == trip.fixes.end();
}

/// Our own writing is never refused.
TripLog read_written(const TripSource& source) {
    try {
        return read_trip(source,
                         {.acc = true, .gyro = true, .speed = true, .fixes = true, .columns = {}});
    } catch (const InputError& refusal) {
        throw std::logic_error{refusal.what()};
    }
}

Answer read_as(const std::string& name, std::string_view input) {
    const TripSource source{.file = input_file(name, input), .member = {}};
    return may_refuse([&] {
        const auto trip = read_trip(source, needs_of_import());
        expect_sound(trip);
        expect(trip.sha256 == content_sha256(source), "a trip has the hash of its content");
    });
}

} // namespace

Answer trip_log(std::string_view input) {
    return read_as("a.trip.csv", input);
}

Answer trip_compressed(std::string_view input) {
    return read_as("a.trip.csv.gz", input); // what it is, the reader sees in its first bytes
}

Answer trip_archive(std::string_view input) {
    const bool is_zip = input.starts_with("PK");
    const auto file = input_file(is_zip ? "a.zip" : "a.tar.gz", input);
    return read_all_of([&] { return testing::find_trips(file); });
}

Answer trip_live(std::string_view input) {
    const auto file = input_file("a.trip.csv", input);
    return may_refuse([&] {
        TripFeed feed{file, needs_of_trace()};
        std::size_t rows = 0;
        while (const auto row = feed.next()) {
            expect(row->rows.size() == 1, "a row comes alone");
            expect(!feed.spoken_row().empty(), "a row can be quoted");
            ++rows;
        }
        expect(rows == feed.count(), "every row is counted");
    });
}

Answer rawlog(std::string_view input) {
    return read_as("a.rawlog", input);
}

Answer gpx(std::string_view input) {
    const TripSource source{.file = input_file("a.gpx", input), .member = {}};
    return may_refuse([&] {
        const auto trip = read_trip(source, needs_of_match());
        expect_sound(trip);
        expect(trip.sha256 == content_sha256(source), "a trip has the hash of its content");
        for (const auto& way : trace_network(std::span{&trip, 1}, TraceConfig{})) {
            expect(way.line.size() == way.node_ids.size() && way.line.size() >= 2,
                   "every point of a way has its node");
        }
    });
}

Answer trip_written(std::string_view input) {
    const TripSource source{.file = input_file("a.trip.csv", input), .member = {}};
    return may_refuse([&] {
        const auto folder = source.file.parent_path();
        const TripSource first{.file = folder / "first.trip.csv", .member = {}};
        const TripSource second{.file = folder / "second.trip.csv", .member = {}};
        const auto trip = read_trip(source, needs_of_import());
        if (!can_be_told_apart(trip)) {
            return;
        }
        write_trip(trip, first.file);
        const auto again = read_written(first);
        expect_sound(again);
        write_trip(again, second.file);
        expect(content_sha256(first) == content_sha256(second),
               "what was written once is written so again");
    });
}

Answer phone_export(std::string_view input) {
    static constexpr std::array<std::string_view, 12> names{"Accelerometer.csv",
                                                            "Acceleration.csv",
                                                            "Linear Acceleration.csv",
                                                            "TotalAcceleration.csv",
                                                            "AccelerometerUncalibrated.csv",
                                                            "Gravity.csv",
                                                            "Gyroscope.csv",
                                                            "Location.csv",
                                                            "Metadata.csv",
                                                            "meta/time.csv",
                                                            "inner/Accelerometer.csv",
                                                            "inner/Location.csv"};
    const auto folder = input_folder(names, input);
    return read_all_of([&] { return testing::find_trips(folder); });
}

Answer mapped_trip(std::string_view input) {
    static constexpr std::array<std::string_view, 3> names{
        "mapping.toml", "a_acc.csv", "a_gnss.csv"};
    const auto folder = input_folder(names, input);
    std::shared_ptr<const TripMapping> mapping;
    const auto answer = may_refuse([&] {
        mapping = std::make_shared<const TripMapping>(read_mapping(folder / "mapping.toml"));
    });
    if (answer == Answer::refused) {
        return answer;
    }
    return both(read_all_of([&] { return testing::find_trips(folder / "a_acc.csv", mapping); }),
                read_all_of([&] { return testing::find_trips(folder, mapping); }));
}

Answer trip_trace(std::string_view input) {
    const TripSource source{.file = input_file("a.trip.csv", input), .member = {}};
    return may_refuse([&] {
        const auto trip = read_trip(source, needs_of_import());
        const auto trace = trace_of(trip, *built_in_vehicle("generic"), {});
        expect_accounted(trip, trace.use);
    });
}

} // namespace macadam::fuzz
