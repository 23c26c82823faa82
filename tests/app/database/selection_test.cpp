// The same selection in `query`, `export`, `render` and `report`.

#include "app/cli/commands.hpp"
#include "app/database/selection.hpp"
#include "app/render/map_scene.hpp"
#include "app/report/report_survey.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/store/road_store.hpp"
#include "storage/tables/csv_table.hpp"
#include "support/files/files.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <set>

namespace macadam::testing {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using Words = std::vector<std::string>;
using Keys = std::set<std::string>;
using Ends = std::array<double, 4>;

Ends ends_of(const std::vector<GeoPoint>& line) {
    return {line.front().lat_deg, line.front().lon_deg, line.back().lat_deg, line.back().lon_deg};
}

const std::array<const Command*, 4> commands_with_selection{
    &query_command, &export_command, &render_command, &report_command};

class SelectionOfSegments : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = test_folder();
        store_ = (folder_ / "roads.gpkg").string();
        auto store = new_store(store_);
        import_trips(store, 5);
        // One more car on three segments, and another on way 2.
        auto passes = passes_of(7);
        passes.resize(3);
        auto trip = trip_record(7);
        trip.vehicle_id = "van";
        add_trip(store, trip, passes);
        passes.resize(1);
        passes[0].segment = {2, true, 0};
        trip = trip_record(8);
        trip.vehicle_id = "lorry";
        add_trip(store, trip, passes);
        store.importer.refresh();
        store.visit({}, [&](const SegmentRecord& record) { measured_.push_back(record); });
    }

    std::string box_around(std::size_t i) const {
        const auto at = halfway_along(measured_.at(i).segment.line);
        constexpr double margin_deg = 5e-6; // half a metre
        return fmt::format("{:.7f},{:.7f},{:.7f},{:.7f}",
                           at.lon_deg - margin_deg,
                           at.lat_deg - margin_deg,
                           at.lon_deg + margin_deg,
                           at.lat_deg + margin_deg);
    }

    /// A triangle around the beginning of way 1, in a file.
    std::string area() const {
        const auto& line = measured_.at(0).segment.line;
        const auto corner = [&](double east_deg, double north_deg) {
            return fmt::format("[{:.7f},{:.7f}]",
                               line.front().lon_deg + east_deg,
                               line.front().lat_deg + north_deg);
        };
        return written(folder_,
                       "area.geojson",
                       fmt::format(R"({{"type":"Feature","properties":{{}},"geometry":)"
                                   R"({{"type":"Polygon","coordinates":[[{0},{1},{2},{0}]]}}}})",
                                   corner(-1e-4, -1e-4),
                                   corner(7e-4, -1e-4),
                                   corner(0, 1e-3)))
            .string();
    }

    Keys rows_of(const Command& command, Words words) const {
        const auto file = (folder_ / "rows.csv").string();
        std::filesystem::remove(file);
        words.insert(words.begin(), store_);
        words.insert(words.end(), {"-o", file, "--quiet"});
        run(command, words);
        Keys keys;
        const auto table = read_csv_table(file);
        for (std::size_t i = 0; i < table.rows.size(); ++i) {
            keys.insert(table.row(i).text("segment"));
        }
        return keys;
    }

    SegmentFilter filter_of(const Command& command, Words words) const {
        words.insert(words.begin(), store_);
        auto filter = parse_filter({command.options, command.operands, std::move(words)});
        complete_filter(filter, RoadStore::open(store_));
        return filter;
    }

    Keys coloured_on_map(const Words& words) const {
        const auto store = RoadStore::open(store_);
        auto filter = filter_of(render_command, words);
        const auto box = filter.box.value_or(store.info().box);
        std::set<Ends> coloured; // the same in no two segments, as lines have a direction
        for (const auto& line : map_lines(store, box, *class_table("fhwa"), 1, filter)) {
            if (line.iri_class >= 0) {
                coloured.insert(ends_of(line.line));
            }
        }
        Keys keys;
        for (const auto& record : measured_) {
            if (coloured.contains(ends_of(record.segment.line))) {
                keys.insert(name_of(record.segment.key));
            }
        }
        return keys;
    }

    Keys in_report(const Words& words) const {
        Keys keys;
        for (const auto& record :
             survey_of(RoadStore::open(store_), filter_of(report_command, words)).measured) {
            keys.insert(name_of(record.key));
        }
        return keys;
    }

    std::filesystem::path folder_;
    std::string store_;
    std::vector<SegmentRecord> measured_;
};

TEST_F(SelectionOfSegments, IsTheSameInFourCommands) {
    const std::vector<Words> selections{{"--bbox=" + box_around(4)},
                                        {"--area", area()},
                                        {"--way", "2"},
                                        {"--road", "ÉPÉE"},
                                        {"--highway", "service"},
                                        {"--class", "poor"},
                                        {"--min-passes", "6"},
                                        {"--min-cars", "4"},
                                        {"--vehicle-id", "van"},
                                        {"--since", "2027-01"},
                                        {"--until", "2025-12-31"},
                                        {"--area", area(), "--class", "fair", "--min-cars", "3"}};
    for (const auto& words : selections) {
        const auto exported = rows_of(export_command, words);
        EXPECT_THAT(exported, AllOf(Not(IsEmpty()), ::testing::SizeIs(::testing::Lt(21U))))
            << words[0];
        if (words[0] != "--min-passes" && words[0] != "--min-cars" && words[0] != "--since" &&
            words[0] != "--until") { // which alone select no roads for query
            EXPECT_EQ(rows_of(query_command, words), exported) << words[0];
        } else {
            auto all_roads = words;
            all_roads.insert(all_roads.end(), {"--bbox=-180,-90,180,90"});
            EXPECT_EQ(rows_of(query_command, all_roads), exported) << words[0];
        }
        EXPECT_EQ(coloured_on_map(words), exported) << words[0];
        EXPECT_EQ(in_report(words), exported) << words[0];
    }
}

TEST_F(SelectionOfSegments, HasTheSameOptionsInFourCommands) {
    for (const auto& option : selection_options) {
        for (const auto* command : commands_with_selection) {
            const auto found = std::ranges::find(command->options, option.name, &Option::name);
            ASSERT_NE(found, command->options.end()) << command->name << " " << option.name;
            EXPECT_EQ(found->help, option.help) << command->name;
            EXPECT_EQ(found->group, "selection") << command->name;
        }
    }
}

TEST_F(SelectionOfSegments, UsesThePassesOfOneCarAlone) {
    auto store = RoadStore::open(store_);
    std::vector<SegmentState> states;
    store.visit(filter_of(query_command, {"--vehicle-id", "van"}),
                [&](const SegmentRecord& record) { states.push_back(*record.state); });
    const auto passes = passes_of(7);
    ASSERT_EQ(states.size(), 3U);
    for (std::size_t i = 0; i < states.size(); ++i) {
        EXPECT_EQ(states[i].passes, 1);
        EXPECT_EQ(states[i].iri_um, passes[i].iri_um); // nothing to fuse
    }
}

TEST_F(SelectionOfSegments, ContinuesOverTheAntimeridian) {
    // Everything but half a globe without these roads.
    const auto roads = rows_of(export_command, {});
    EXPECT_EQ(rows_of(export_command, {"--bbox=100,-80,20,80"}), roads);
    EXPECT_THAT(rows_of(export_command, {"--bbox=100,-80,-100,80"}), IsEmpty());
}

TEST_F(SelectionOfSegments, RefusesACarThatTheDatabaseDoesNotHaveAndAFileWithoutPolygon) {
    EXPECT_THAT(refusal_of([&] {
                    rows_of(export_command, {"--vehicle-id", "tram"});
                }),
                HasSubstr("has no car 'tram', expected a vehicle_id"));
    const auto line =
        written(folder_, "line.geojson", R"({"type":"LineString","coordinates":[[4,45],[5,46]]})");
    EXPECT_THAT(refusal_of([&] {
                    rows_of(export_command, {"--area", line.string()});
                }),
                EndsWith("line.geojson: contains no polygon, expected the outline of an area"));
    EXPECT_THAT(refusal_of([&] {
                    rows_of(export_command, {"--area", "none.geojson"});
                }),
                HasSubstr("none.geojson"));
}

TEST_F(SelectionOfSegments, IsToldInWordsWithoutTheNameOfACar) {
    const Arguments arguments{report_command.options,
                              report_command.operands,
                              {store_, "--road", "Rue de l'", "--vehicle-id", "van", "--way", "1"}};
    EXPECT_EQ(text_of_filter(arguments), R"(--way 1 --road "Rue de l'" --vehicle-id ...)");
    EXPECT_EQ(text_of_filter(arguments, "--road"), "--way 1 --vehicle-id ...");
}

} // namespace
} // namespace macadam::testing
