#include "storage/exports/qgis_project.hpp"

#include "storage/atomic/atomic_file.hpp"
#include "storage/exports/zip_archive.hpp"
#include "storage/styles/road_style.hpp"
#include "storage/text/xml_escape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

namespace macadam {
namespace {

namespace fs = std::filesystem;

constexpr const char* roads_id = "roughness_of_macadam";
constexpr const char* base_id = "openstreetmap_of_macadam";
constexpr const char* base_source = "type=xyz&url=https://tile.openstreetmap.org/%7Bz%7D/%7Bx%7D/"
                                    "%7By%7D.png&zmin=0&zmax=19";

/// Position in spherical Mercator, EPSG:3857, metres.
double mercator_x_m(double lon_deg) {
    constexpr double radius_m = 6'378'137; // EPSG:7059, also below
    return radius_m * lon_deg * std::numbers::pi / 180;
}

double mercator_y_m(double lat_deg) {
    constexpr double radius_m = 6'378'137;
    constexpr double last_deg = 85.05; // the edge of its square
    const double lat_rad = std::clamp(lat_deg, -last_deg, last_deg) * std::numbers::pi / 180;
    return radius_m * std::asinh(std::tan(lat_rad));
}

std::string extent_of(const GeoBox& box) {
    return fmt::format("<extent><xmin>{:.2f}</xmin><ymin>{:.2f}</ymin><xmax>{:.2f}</"
                       "xmax><ymax>{:.2f}</ymax></extent>",
                       mercator_x_m(box.west_deg),
                       mercator_y_m(box.south_deg),
                       mercator_x_m(box.east_deg),
                       mercator_y_m(box.north_deg));
}

/// Coordinate reference system: its number in QGIS, and that of EPSG.
struct Crs {
    int srsid;
    int epsg;
};
constexpr Crs geographic{3452, 4326};
constexpr Crs mercator{3857, 3857};

std::string crs_element(std::string_view element, const Crs& crs) {
    return fmt::format("<{0}><spatialrefsys><srsid>{1}</srsid><authid>EPSG:{2}</authid>"
                       "</spatialrefsys></{0}>\n",
                       element,
                       crs.srsid,
                       crs.epsg);
}

/// Source of the layer: the database, relative to the folder of the project.
std::string source_of(const fs::path& store, const fs::path& project) {
    const auto folder = fs::absolute(project).lexically_normal().parent_path();
    const auto path = fs::absolute(store).lexically_normal().lexically_relative(folder).string();
    return fmt::format("{}{}|layername=roughness", path.starts_with("..") ? "" : "./", path);
}

std::string
tree_layer(const char* id, const char* name, const char* provider, const std::string& source) {
    return fmt::format(R"(<layer-tree-layer id="{}" name="{}" providerKey="{}" source="{}" )"
                       R"(checked="Qt::Checked" expanded="1"/>)"
                       "\n",
                       id,
                       name,
                       provider,
                       xml_text(source));
}

std::string project_text(const StoreReader& store, const fs::path& file) {
    constexpr const char* name = "Roughness (IRI in mm/m)";
    const auto& classes = *class_table(store.settings().class_table);
    const auto source = source_of(store.file(), file);
    const auto title = xml_text(file.stem().string());
    std::string text = "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n";
    text +=
        fmt::format("<qgis projectname=\"{0}\" version=\"3.22.16\">\n<title>{0}</title>\n", title);
    text += crs_element("projectCrs", mercator);
    text += "<layer-tree-group>\n" + tree_layer(roads_id, name, "ogr", source) +
            tree_layer(base_id, "OpenStreetMap", "wms", base_source) + "</layer-tree-group>\n";
    text += "<mapcanvas name=\"theMapCanvas\" annotationsVisible=\"1\"><units>meters</units>" +
            extent_of(store.map_box()) + crs_element("destinationsrs", mercator) + "</mapcanvas>\n";
    text += "<projectlayers>\n";
    text +=
        fmt::format("<maplayer type=\"vector\" geometry=\"Line\" labelsEnabled=\"1\">\n<id>{}</id>"
                    "<datasource>{}</datasource><layername>{}</layername>\n"
                    "<provider encoding=\"UTF-8\">ogr</provider>\n"
                    "<resourceMetadata><rights>{}</rights></resourceMetadata>\n",
                    roads_id,
                    xml_text(source),
                    name,
                    xml_text(store.settings().attribution));
    text += crs_element("srs", geographic) + qgis_layer_elements({classes}) + "</maplayer>\n";
    text += fmt::format(
        "<maplayer type=\"raster\">\n<id>{}</id><datasource>{}</datasource>"
        "<layername>OpenStreetMap</layername>\n<provider>wms</provider>\n"
        "<resourceMetadata><rights>© OpenStreetMap contributors</rights></resourceMetadata>\n{}"
        "</maplayer>\n",
        base_id,
        xml_text(base_source),
        crs_element("srs", mercator));
    text += "</projectlayers>\n<properties><Paths><Absolute type=\"bool\">false</Absolute></Paths>"
            "<SpatialRefSys><ProjectionsEnabled type=\"int\">1</ProjectionsEnabled></SpatialRefSys>"
            "</properties>\n";
    return text + "</qgis>\n";
}

} // namespace

void write_qgis_project(const StoreReader& store, const fs::path& file) {
    AtomicFile out{file};
    out.write(zip_archive(file.stem().string() + ".qgs", project_text(store, file)));
    store.expect_in_place();
    out.commit();
}

} // namespace macadam
