#include "storage/gdal/ogr_line_writer.hpp"

#include "estimator/common/error.hpp"
#include "storage/gdal/gdal_access.hpp"
#include "storage/gdal/gdal_errors.hpp"

#include <cpl_string.h>
#include <fmt/core.h>
#include <ogrsf_frmts.h>

namespace macadam {

namespace {

[[noreturn]] void fail() {
    // GDAL reports a full disk as "Unexpected I/O failure".
    throw InputError{fmt::format("cannot be written: {}; the disk may be full",
                                 gdal_error("unknown GDAL error"))};
}

void expect(OGRErr result) {
    if (result != OGRERR_NONE) {
        fail();
    }
}

OGRFieldType type_of(const LineFileColumn& column) {
    switch (column.type) {
    case LineFileColumn::Type::integer:
        return OFTInteger64;
    case LineFileColumn::Type::real:
        return OFTReal;
    case LineFileColumn::Type::day:
        return OFTDate;
    case LineFileColumn::Type::text:
        break;
    }
    return OFTString;
}

GDALDatasetUniquePtr create(const LineFile& what) {
    const auto file = std::filesystem::absolute(what.file);
    auto& driver = driver_to_write(what.driver, file.parent_path());
    GDALDatasetUniquePtr dataset{driver.Create(file.c_str(), 0, 0, 0, GDT_Unknown, nullptr)};
    if (!dataset) {
        fail();
    }
    return dataset;
}

OGRLayer& create_layer(GDALDataset& dataset, const LineFile& what) {
    OGRSpatialReference wgs84;
    wgs84.SetWellKnownGeogCS("WGS84");
    wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    CPLStringList options;
    for (const auto& [name, value] : what.options) {
        options.SetNameValue(name.c_str(), value.c_str());
    }
    auto* const layer =
        dataset.CreateLayer(what.layer.c_str(), &wgs84, wkbLineString, options.List());
    if (layer == nullptr) {
        fail();
    }
    for (const auto& column : what.columns) {
        OGRFieldDefn field{std::string{column.name}.c_str(), type_of(column)};
        field.SetWidth(column.width);
        field.SetPrecision(column.decimals);
        expect(layer->CreateField(&field));
    }
    return *layer;
}

OGRLineString line_of(const std::vector<GeoPoint>& points) {
    OGRLineString line;
    for (const auto& point : points) {
        line.addPoint(point.lon_deg, point.lat_deg);
    }
    return line;
}

void put_line(OGRLayer& layer,
              const LineParts& parts,
              const std::vector<std::optional<std::string>>& values) {
    OGRFeature feature{layer.GetLayerDefn()};
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i]) {
            feature.SetField(static_cast<int>(i), values[i]->c_str());
        }
    }
    if (parts.size() == 1) {
        const auto line = line_of(parts.front());
        feature.SetGeometry(&line);
    } else {
        OGRMultiLineString lines;
        for (const auto& part : parts) {
            const auto line = line_of(part);
            lines.addGeometry(&line);
        }
        feature.SetGeometry(&lines);
    }
    expect(layer.CreateFeature(&feature));
}

/// Checks the number of written lines, because GDAL does not report a full disk on closing.
void expect_lines(const LineFile& what, std::size_t count) {
    const auto dataset = reopen_lines(what.file, what.driver);
    std::size_t found = 0;
    const auto has_columns = [&](OGRLayer& layer) {
        return layer.GetLayerDefn()->GetFieldCount() >= static_cast<int>(what.columns.size());
    };
    if (dataset && dataset->GetLayerCount() == 1 && has_columns(*dataset->GetLayer(0))) {
        for (const auto& feature : dataset->GetLayer(0)) {
            found += feature->GetGeometryRef() != nullptr ? 1 : 0;
        }
    }
    if (found != count) {
        throw InputError{
            fmt::format("cannot be written: only {1} of {0} lines can be read back; the disk "
                        "may be full",
                        count,
                        found)};
    }
}

void write(const LineFile& what, const std::function<void(const LinePut& put)>& give) {
    const GdalErrorScope quiet;
    auto dataset = create(what);
    auto& layer = create_layer(*dataset, what);
    std::size_t count = 0;
    give([&](const auto& parts, const auto& values) {
        put_line(layer, parts, values);
        ++count;
    });
    CPLErrorReset();
    dataset.reset(); // some formats are written only on closing
    if (CPLGetLastErrorType() == CE_Failure) {
        fail();
    }
    expect_lines(what, count);
}

} // namespace

} // namespace macadam

extern "C" void macadam_line_file_write(const macadam::LineFile& file,
                                        const std::function<void(const macadam::LinePut&)>& give) {
    macadam::write(file, give);
}
