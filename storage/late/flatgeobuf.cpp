#include "storage/late/flatgeobuf.hpp"

#include "estimator/common/error.hpp"
#include "storage/late/gdal_errors.hpp"

#include <cpl_string.h>
#include <fmt/core.h>
#include <ogrsf_frmts.h>

#include <memory>
#include <system_error>

namespace macadam {

namespace {

[[noreturn]] void fail() {
    // GDAL calls a full disk "Unexpected I/O failure".
    throw InputError{fmt::format("cannot be written: {}; the disk may be full",
                                 gdal_said("GDAL does not say why"))};
}

void expect(OGRErr result) {
    if (result != OGRERR_NONE) {
        fail();
    }
}

/// Takes back what was written, unless it is whole. GDAL gathers the features in a file beside.
class Unfinished {
public:
    explicit Unfinished(std::filesystem::path file) : file_{std::move(file)} {}
    Unfinished(const Unfinished&) = delete;
    Unfinished& operator=(const Unfinished&) = delete;
    ~Unfinished() {
        std::error_code ignored;
        auto beside = file_;
        beside.replace_extension();
        beside += "_temp.fgb";
        std::filesystem::remove(beside, ignored);
        if (!whole_) {
            std::filesystem::remove(file_, ignored);
        }
    }

    void is_whole() { whole_ = true; }

private:
    std::filesystem::path file_;
    bool whole_ = false;
};

OGRFieldType type_of(const FlatGeobufColumn& column) {
    switch (column.type) {
    case FlatGeobufColumn::Type::integer:
        return OFTInteger64;
    case FlatGeobufColumn::Type::real:
        return OFTReal;
    case FlatGeobufColumn::Type::time:
        return OFTDateTime;
    case FlatGeobufColumn::Type::text:
        break;
    }
    return OFTString;
}

GDALDatasetUniquePtr create(const std::filesystem::path& file) {
    GDALAllRegister();
    auto* const driver = GetGDALDriverManager()->GetDriverByName("FlatGeobuf");
    if (driver == nullptr) {
        throw InputError{"cannot be written: this GDAL knows no FlatGeobuf"};
    }
    GDALDatasetUniquePtr dataset{
        driver->Create(std::filesystem::absolute(file).c_str(), 0, 0, 0, GDT_Unknown, nullptr)};
    if (!dataset) {
        fail();
    }
    return dataset;
}

OGRLayer& create_layer(GDALDataset& dataset, const FlatGeobufLayer& what) {
    OGRSpatialReference wgs84;
    wgs84.SetWellKnownGeogCS("WGS84");
    wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    CPLStringList options;
    options.SetNameValue("SPATIAL_INDEX", "YES");
    options.SetNameValue("DESCRIPTION", what.description.c_str());
    auto* const layer =
        dataset.CreateLayer(what.name.c_str(), &wgs84, wkbLineString, options.List());
    if (layer == nullptr) {
        fail();
    }
    for (const auto& column : what.columns) {
        OGRFieldDefn field{std::string{column.name}.c_str(), type_of(column)};
        expect(layer->CreateField(&field));
    }
    return *layer;
}

void put_line(OGRLayer& layer,
              const std::vector<GeoPoint>& line,
              const std::vector<std::optional<std::string>>& values) {
    OGRFeature feature{layer.GetLayerDefn()};
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i]) {
            feature.SetField(static_cast<int>(i), values[i]->c_str());
        }
    }
    OGRLineString shape;
    for (const auto& point : line) {
        shape.addPoint(point.lon_deg, point.lat_deg);
    }
    feature.SetGeometry(&shape);
    expect(layer.CreateFeature(&feature));
}

/// GDAL says nothing of a full disk that shows only when the file is closed.
void expect_lines(const std::filesystem::path& file, std::size_t count) {
    const GDALDatasetUniquePtr dataset{GDALDataset::Open(std::filesystem::absolute(file).c_str(),
                                                         GDAL_OF_VECTOR | GDAL_OF_READONLY)};
    std::size_t found = 0;
    if (dataset && dataset->GetLayerCount() == 1) {
        for (const auto& feature : dataset->GetLayer(0)) {
            found += feature->GetGeometryRef() != nullptr ? 1 : 0;
        }
    }
    if (found != count) {
        throw InputError{
            fmt::format("cannot be written: of {} lines only {} can be read again; the disk may be "
                        "full",
                        count,
                        found)};
    }
}

void write(const FlatGeobufLayer& what, const std::function<void(const FlatGeobufPut& put)>& give) {
    const Quiet quiet;
    Unfinished file{what.file};
    auto dataset = create(what.file);
    auto& layer = create_layer(*dataset, what);
    std::size_t count = 0;
    give([&](const auto& line, const auto& values) {
        put_line(layer, line, values);
        ++count;
    });
    CPLErrorReset();
    dataset.reset(); // the file itself is written now, from the index on
    if (CPLGetLastErrorType() == CE_Failure) {
        fail();
    }
    expect_lines(what.file, count);
    file.is_whole();
}

} // namespace

} // namespace macadam

extern "C" void
macadam_flatgeobuf_write(const macadam::FlatGeobufLayer& layer,
                         const std::function<void(const macadam::FlatGeobufPut&)>& give) {
    macadam::write(layer, give);
}
