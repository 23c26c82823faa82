// What other programs find in our files, read by GDAL's own tool and held against the store, field
// by field.

#include "mapping/network/build_network.hpp"
#include "storage/exports/export.hpp"
#include "support/files/files.hpp"
#include "support/files/gdal_reading.hpp"
#include "support/program/shell.hpp"
#include "support/roads/road_art.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Names in many scripts, and those that have broken other writers.
const std::vector<std::string> names{
    "Rue de l'Épée 100%",
    "=HYPERLINK(\"x\"), <b>&amp;</b> ]]> \\ ' `",
    "Ωμέγα Вулиця שדרות شارع 日本橋 हिन्दी ถนน 😀",
    "line\nfeed, tab\t, return\r.",
    "control \x01\x1f end",
    std::string(300, 'x'),
    std::string(253, 'y') + "é", // 255 bytes, the last letter of two
    "-1",
    "NULL",
};

/// A road for each name, and one without; the first has passes of six trips.
RoadNetwork country_of_names() {
    auto ways = road_art("A---B", 100, {"AB"}).ways;
    const auto first = ways.front();
    for (std::size_t i = 0; i <= names.size(); ++i) {
        auto way = first;
        way.id = std::int64_t(i) + 1;
        way.name = i < names.size() ? names[i] : "";
        way.highway = i % 2 == 0 ? "residential" : "";
        for (auto& node : way.node_ids) {
            node += std::int64_t(i) * 1000;
        }
        for (auto& point : way.line) {
            point.lat_deg += 0.01 * double(i);
        }
        if (i == 0) {
            ways.front() = way;
        } else {
            ways.push_back(way);
        }
    }
    ways.back().id = 99'999'999'999; // more than 32 bits
    return build_network(std::move(ways), 20);
}

RoadStore store_of_names(const fs::path& file) {
    auto store = RoadStore::create(file, country_of_names(), settings());
    import_trips(store, 6);
    return store;
}

using Values = std::map<std::string, std::optional<std::string>>;

/// What a kind of file says of each field, by its own limits (docs/reference/exports.md).
using Limits = std::function<Values(Values)>;

Values values_of(const SegmentRecord& record) {
    Values values;
    const auto texts = attribute_texts({record, *class_table("fhwa")});
    for (std::size_t i = 0; i < texts.size(); ++i) {
        values.emplace(segment_attributes()[i].name, texts[i]);
    }
    return values;
}

/// A field of a feature against the text that it should be.
void expect_equal(const json& found,
                  const std::optional<std::string>& expected,
                  const Column<ClassedSegment>& field,
                  const std::string& where) {
    if (!expected) {
        EXPECT_TRUE(found.is_null() || found == "") << where << " " << found;
        return;
    }
    ASSERT_FALSE(found.is_null()) << where;
    const auto kind = field.type.kind;
    if (kind == ColumnType::Kind::integer || kind == ColumnType::Kind::real) {
        const double value =
            found.is_number() ? found.get<double>() : std::stod(found.get<std::string>());
        EXPECT_EQ(value, std::stod(*expected)) << where;
        return;
    }
    ASSERT_TRUE(found.is_string()) << where << " " << found;
    auto text = found.get<std::string>();
    if (kind == ColumnType::Kind::day) { // 2018/08/02
        std::ranges::replace(text, '/', '-');
    }
    EXPECT_EQ(text, *expected) << where;
}

struct Kind {
    std::string suffix;
    double tolerance_deg; ///< of coordinates; 0: the kind has no lines
    std::map<std::string, std::string> renamed{};
    Limits limits = [](Values values) { return values; };
};

void expect_round_trip(const Kind& kind) {
    const auto folder = test_folder();
    const auto store = store_of_names(folder / "store.gpkg");
    SegmentFilter all;
    all.with_state_only = false;
    const auto count = export_segments(store, all, folder / ("out" + kind.suffix));
    std::map<std::string, json> features;
    const auto collection = collection_by_gdal(folder, "out" + kind.suffix);
    for (const auto& feature : collection["features"]) {
        features.emplace(feature["properties"]["segment"].get<std::string>(), feature);
    }
    ASSERT_EQ(features.size(), count);
    std::size_t with_state = 0;
    std::size_t without = 0;
    store.visit(all, [&](const SegmentRecord& record) {
        const auto segment = name_of(record.segment.key);
        ASSERT_TRUE(features.contains(segment)) << segment;
        const auto& feature = features.at(segment);
        const auto expected = kind.limits(values_of(record));
        for (const auto& field : segment_attributes()) {
            const std::string name{field.name};
            const auto renamed = kind.renamed.find(name);
            const auto& there = renamed == kind.renamed.end() ? name : renamed->second;
            const auto& properties = feature["properties"];
            const bool listed = properties.contains(there);
            EXPECT_TRUE(listed || !expected.at(name)) << there;
            expect_equal(listed ? properties[there] : json{},
                         expected.at(name),
                         field,
                         segment + " " + name);
        }
        if (kind.tolerance_deg > 0) {
            expect_line(
                feature["geometry"]["coordinates"], record.segment.line, kind.tolerance_deg);
        }
        ++(record.state ? with_state : without);
    });
    EXPECT_GT(with_state, 0U);
    EXPECT_GT(without, 0U);
}

constexpr double nine_decimals_deg = 6e-10; // what the tool writes for us to read

TEST(ExportRoundTrip, OfGeoJsonLosesNothing) {
    expect_round_trip({".geojson", seven_decimals_deg});
}

TEST(ExportRoundTrip, OfGeoJsonLinesLosesNothing) {
    expect_round_trip({".geojsonl", seven_decimals_deg});
}

TEST(ExportRoundTrip, OfGeoPackageLosesNothing) {
    expect_round_trip({".gpkg", nine_decimals_deg});
}

TEST(ExportRoundTrip, OfFlatGeobufLosesNothing) {
    expect_round_trip({".fgb", nine_decimals_deg});
}

TEST(ExportRoundTrip, OfCsvLosesNothingButSetsAnApostropheBeforeFormulas) {
    expect_round_trip({".csv", 0, {}, [](Values values) {
                           auto& name = values["name"];
                           if (name && (name->starts_with('=') || name->starts_with('-'))) {
                               name = "'" + *name;
                           }
                           if (name) { // the file has it; GDAL reads a line feed
                               std::ranges::replace(*name, '\r', '\n');
                           }
                           return values;
                       }});
}

TEST(ExportRoundTrip, OfShapefileLosesTheEndsOfVeryLongNames) {
    expect_round_trip(
        {".shp", nine_decimals_deg, {{"trend_per_year", "trend_year"}}, [](Values values) {
             auto& name = values["name"];
             if (name && name->size() > 254) {
                 name = name->substr(0, name->back() == 'x' ? 254 : 253);
             }
             return values;
         }});
}

TEST(ExportRoundTrip, OfKmlLosesControlCharacters) {
    expect_round_trip({".kml", seven_decimals_deg, {{"name", "Name"}}, [](Values values) {
                           auto& name = values["name"];
                           if (name && name->starts_with("control")) {
                               name = "control \xef\xbf\xbd\xef\xbf\xbd end";
                           }
                           return values;
                       }});
}

// ----------------------------------------------------------------------------------- FlatGeobuf

/// How many features GDAL finds in a box, by the index of the file.
std::size_t found_in(const fs::path& folder, const std::string& name, const GeoBox& box) {
    const auto info = output_of(folder,
                                fmt::format("ogrinfo -ro -so -al -spat {} {} {} {} {}",
                                            box.west_deg,
                                            box.south_deg,
                                            box.east_deg,
                                            box.north_deg,
                                            (folder / name).string()));
    const std::string label = "Feature Count: ";
    const auto at = info.find(label);
    EXPECT_NE(at, std::string::npos) << info;
    return at == std::string::npos ? 0 : std::stoul(info.substr(at + label.size()));
}

bool touch(const GeoBox& a, const GeoBox& b) {
    return a.west_deg <= b.east_deg && b.west_deg <= a.east_deg && a.south_deg <= b.north_deg &&
           b.south_deg <= a.north_deg;
}

TEST(FlatGeobufIndex, FindsWhatLiesInABox) {
    const auto folder = test_folder();
    const auto store = store_of_names(folder / "store.gpkg");
    // Trees of two and of three levels, and of a single leaf.
    std::vector<SegmentFilter> choices(3);
    choices[0].with_state_only = false;
    choices[1].with_state_only = false;
    choices[1].way_id = 2;
    choices[2].key = SegmentKey{1, true, 0};
    for (const auto& choice : choices) {
        std::vector<GeoBox> boxes;
        GeoBox all;
        store.visit(choice, [&](const SegmentRecord& record) {
            boxes.emplace_back();
            for (const auto& point : record.segment.line) {
                boxes.back() = including(boxes.back(), point);
                all = including(all, point);
            }
        });
        ASSERT_FALSE(boxes.empty());
        EXPECT_EQ(export_segments(store, choice, folder / "out.fgb"), boxes.size());
        for (const double share : {0.0, 0.3, 0.7, 1.0}) {
            const GeoBox corner{all.west_deg,
                                all.south_deg,
                                std::lerp(all.west_deg, all.east_deg, share) + 1e-5,
                                std::lerp(all.south_deg, all.north_deg, share) + 1e-5};
            const auto expected =
                std::ranges::count_if(boxes, [&](const GeoBox& box) { return touch(box, corner); });
            EXPECT_EQ(found_in(folder, "out.fgb", corner), std::size_t(expected));
        }
        EXPECT_EQ(found_in(folder, "out.fgb", {0, 0, 1, 1}), 0U);
    }
}

} // namespace
} // namespace macadam::testing
