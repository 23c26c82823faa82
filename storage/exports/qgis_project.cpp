#include "storage/exports/qgis_project.hpp"

#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_file.hpp"
#include "storage/styles/road_style.hpp"
#include "storage/text/xml_escape.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

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

std::string crs(std::string_view element, int epsg) {
    return fmt::format(
        "<{0}><spatialrefsys><authid>EPSG:{1}</authid></spatialrefsys></{0}>\n", element, epsg);
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
    text += crs("projectCrs", 3857);
    text += "<layer-tree-group>\n" + tree_layer(roads_id, name, "ogr", source) +
            tree_layer(base_id, "OpenStreetMap", "wms", base_source) + "</layer-tree-group>\n";
    text += "<mapcanvas name=\"theMapCanvas\" annotationsVisible=\"1\"><units>meters</units>" +
            extent_of(store.map_box()) + crs("destinationsrs", 3857) + "</mapcanvas>\n";
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
    text += crs("srs", 4326) + qgis_layer_elements(classes) + "</maplayer>\n";
    text += fmt::format(
        "<maplayer type=\"raster\">\n<id>{}</id><datasource>{}</datasource>"
        "<layername>OpenStreetMap</layername>\n<provider>wms</provider>\n"
        "<resourceMetadata><rights>© OpenStreetMap contributors</rights></resourceMetadata>\n{}"
        "</maplayer>\n",
        base_id,
        xml_text(base_source),
        crs("srs", 3857));
    text += "</projectlayers>\n<properties><Paths><Absolute "
            "type=\"bool\">false</Absolute></Paths></properties>\n";
    return text + "</qgis>\n";
}

/// Returns a ZIP archive of one file.
std::string zip_of(const std::string& name, const std::string& content) {
    struct Free {
        void operator()(archive* zip) const { archive_write_free(zip); }
        void operator()(archive_entry* entry) const { archive_entry_free(entry); }
    };
    constexpr std::size_t room_bytes = 4096; // for headers; deflate never adds more to a text
    std::string bytes(content.size() + name.size() + room_bytes, '\0');
    std::size_t used = 0;
    const std::unique_ptr<archive, Free> zip{archive_write_new()};
    const std::unique_ptr<archive_entry, Free> entry{archive_entry_new()};
    archive_entry_set_pathname_utf8(entry.get(), name.c_str());
    archive_entry_set_size(entry.get(), static_cast<la_int64_t>(content.size()));
    archive_entry_set_filetype(entry.get(), AE_IFREG);
    archive_entry_set_perm(entry.get(), 0644);
    constexpr std::time_t first_of_zip_s = 315'619'200; // 1980-01-02: equal projects, equal bytes
    archive_entry_set_mtime(entry.get(), first_of_zip_s, 0);
    const bool is_written =
        archive_write_set_format_zip(zip.get()) == ARCHIVE_OK &&
        archive_write_open_memory(zip.get(), bytes.data(), bytes.size(), &used) == ARCHIVE_OK &&
        archive_write_header(zip.get(), entry.get()) == ARCHIVE_OK &&
        archive_write_data(zip.get(), content.data(), content.size()) ==
            static_cast<la_ssize_t>(content.size()) &&
        archive_write_close(zip.get()) == ARCHIVE_OK;
    if (!is_written) {
        const auto* const words = archive_error_string(zip.get());
        throw InputError{fmt::format(
            "{}: cannot be compressed: {}", name, words != nullptr ? words : "unknown error")};
    }
    bytes.resize(used);
    return bytes;
}

} // namespace

void write_qgis_project(const StoreReader& store, const fs::path& file) {
    AtomicFile out{file};
    out.write(zip_of(file.stem().string() + ".qgs", project_text(store, file)));
    store.expect_in_place();
    out.commit();
}

} // namespace macadam
