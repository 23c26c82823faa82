// Styles beside exports, the project for QGIS, and the tables that other programs are offered.

#include "storage/exports/style_files.hpp"

#include "storage/exports/export.hpp"
#include "storage/exports/qgis_project.hpp"
#include "storage/styles/road_style.hpp"
#include "support/files/files.hpp"
#include "support/program/shell.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(StyleFiles, LieBesideLayersOfOtherPrograms) {
    const auto folder = test_folder();
    const auto store = new_store(folder / "a.gpkg");
    for (const auto* suffix : {".geojson", ".fgb", ".shp"}) {
        fs::remove(folder / "out.qml");
        fs::remove(folder / "out.sld");
        export_segments(store, {}, folder / (std::string{"out"} + suffix));
        EXPECT_THAT(content_of(folder / "out.qml"), HasSubstr("good (below 1.50 mm/m)")) << suffix;
        EXPECT_THAT(content_of(folder / "out.sld"), HasSubstr("poor (above 2.68 mm/m)")) << suffix;
    }
    export_segments(store, {}, folder / "plain.csv");
    EXPECT_FALSE(fs::exists(folder / "plain.qml"));
}

TEST(StyleFiles, GiveWayToThoseThatUsersSaved) {
    const auto folder = test_folder();
    write_style_files(folder / "out.shp", folder, {*class_table("five")});
    EXPECT_THAT(content_of(folder / "out.qml"), HasSubstr("2.50 to 3.50 mm/m"));
    write_style_files(folder / "out.shp", folder, {*class_table("fhwa")});
    EXPECT_THAT(content_of(folder / "out.qml"), Not(HasSubstr("2.50 to 3.50 mm/m")));
    written(folder, "out.qml", "<qgis>mine</qgis>");
    write_style_files(folder / "out.shp", folder, {*class_table("five")});
    EXPECT_EQ(content_of(folder / "out.qml"), "<qgis>mine</qgis>");
    EXPECT_THAT(content_of(folder / "out.sld"), HasSubstr("2.50 to 3.50 mm/m"));
}

TEST(RoadStyle, IsWellFormedAndHasTheLimitsOfTheClasses) {
    const auto folder = test_folder();
    const auto& classes = *class_table("fhwa");
    const auto qml = qml_style({classes});
    EXPECT_THAT(qml, HasSubstr(R"(lower="1.499368687" upper="2.683080808")")); // 95 and 170 in/mi
    // 170 in/mi is fair, 95 is fair, too: 23 CFR 490.313.
    const auto sld = sld_style({classes}, "a<b");
    EXPECT_THAT(sld, HasSubstr("<se:Name>a&lt;b</se:Name>"));
    EXPECT_THAT(sld,
                HasSubstr("PropertyIsGreaterThanOrEqualTo><ogc:PropertyName>iri</ogc:PropertyName>"
                          "<ogc:Literal>1.499369"));
    EXPECT_THAT(sld,
                HasSubstr("PropertyIsGreaterThan><ogc:PropertyName>iri</ogc:PropertyName>"
                          "<ogc:Literal>2.683081"));
}

/// Project within an archive, as another reader of ZIP finds it.
std::string
project_in(const fs::path& folder, const std::string& archive, const std::string& name) {
    return output_of(folder,
                     "/usr/bin/python3 -c 'import sys, zipfile; "
                     "print(zipfile.ZipFile(sys.argv[1]).read(sys.argv[2]).decode())' " +
                         (folder / archive).string() + " " + name);
}

TEST(QgisProject, IsAnArchiveThatNamesTheDatabaseFromItsFolder) {
    const auto folder = test_folder();
    const auto store = new_store(folder / "a & b.gpkg");
    fs::create_directory(folder / "maps");
    write_qgis_project(store, folder / "maps" / "town.qgz");
    const auto project = project_in(folder, "maps/town.qgz", "town.qgs");
    EXPECT_THAT(project,
                HasSubstr("<datasource>../a &amp; b.gpkg|layername=roughness</datasource>"));
    EXPECT_THAT(project, HasSubstr("good (below 1.50 mm/m)"));
    write_qgis_project(store, folder / "again.qgz");
    EXPECT_THAT(project_in(folder, "again.qgz", "again.qgs"),
                HasSubstr("<datasource>./a &amp; b.gpkg|"));
}

TEST(RoadDatabase, OffersItsLayersAndNoInnerTable) {
    const auto folder = test_folder();
    new_store(folder / "a.gpkg");
    const auto offered =
        output_of(folder, "ogrinfo -ro -oo LIST_ALL_TABLES=YES " + (folder / "a.gpkg").string());
    EXPECT_THAT(offered, HasSubstr("roughness"));
    for (const auto* const inner : {"pass", "trip", "vehicle", "meta", "audit"}) {
        EXPECT_THAT(offered, Not(HasSubstr(std::string{": "} + inner))) << inner;
    }
}

} // namespace
} // namespace macadam::testing
