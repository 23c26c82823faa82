#include "storage/networks/ogr_reader.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/exact_number.hpp"
#include "storage/gdal/gdal_access.hpp"
#include "storage/gdal/gdal_errors.hpp"
#include "storage/gdal/layer_coordinates.hpp"
#include "storage/networks/osm_tags.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace macadam {

namespace {

bool is_of_lines(OGRLayer& layer) {
    const auto kind = wkbFlatten(layer.GetGeomType());
    return kind == wkbLineString || kind == wkbMultiLineString || kind == wkbUnknown ||
           kind == wkbGeometryCollection;
}

OGRLayer& layer_of(GDALDataset& dataset, const std::string& name, const std::string& file) {
    std::string names;
    for (auto* const layer : dataset.GetLayers()) {
        if (name.empty() ? is_of_lines(*layer) : name == layer->GetName()) {
            return *layer;
        }
        names += fmt::format("{}'{}'", names.empty() ? "" : ", ", layer->GetName());
    }
    if (name.empty()) {
        throw InputError{fmt::format("{}: has no layer of lines, only {}", file, names)};
    }
    throw InputError{fmt::format("{}: has no layer '{}', only {}", file, name, names)};
}

/// Index of the requested column, or of the first usual one that exists; -1 if there is none.
int column(OGRLayer& layer,
           const std::string& asked,
           std::initializer_list<const char*> usual,
           const std::string& file) {
    auto* const definition = layer.GetLayerDefn();
    if (!asked.empty()) {
        const int index = definition->GetFieldIndex(asked.c_str());
        if (index < 0) {
            throw InputError{
                fmt::format("{}: layer '{}' has no column '{}'", file, layer.GetName(), asked)};
        }
        return index;
    }
    for (const char* const name : usual) {
        if (const int index = definition->GetFieldIndex(name); index >= 0) {
            return index;
        }
    }
    return -1;
}

std::string text_in(const OGRFeature& feature, int column) {
    return column >= 0 && feature.IsFieldSetAndNotNull(column) ? feature.GetFieldAsString(column)
                                                               : "";
}

/// Returns the first text of a list as osmnx writes it where it joined roads, such as
/// ['Kungsgatan', 'Kungsbron']; other texts as they are.
std::string first_of_list(std::string text) {
    if (text.size() < 4 || text[0] != '[' || (text[1] != '\'' && text[1] != '"')) {
        return text;
    }
    const auto end = text.find(text[1], 2);
    return end == std::string::npos ? text : text.substr(2, end - 2);
}

std::optional<Oneway> parse_oneway(std::string_view text) {
    struct Spelling {
        std::string_view text;
        Oneway oneway;
    };
    // Spellings of OSM, flags of osmnx and others, letters of Geofabrik, and from-to of Esri's
    // networks.
    static constexpr Spelling spellings[] = {
        {"", Oneway::no},
        {"no", Oneway::no},
        {"0", Oneway::no},
        {"false", Oneway::no},
        {"False", Oneway::no},
        {"B", Oneway::no},
        {"reversible", Oneway::no},
        {"alternating", Oneway::no},
        {"yes", Oneway::forward},
        {"1", Oneway::forward},
        {"true", Oneway::forward},
        {"True", Oneway::forward},
        {"F", Oneway::forward},
        {"FT", Oneway::forward},
        {"-1", Oneway::backward},
        {"T", Oneway::backward},
        {"TF", Oneway::backward},
        {"reverse", Oneway::backward},
    };
    for (const auto& spelling : spellings) {
        if (spelling.text == text) {
            return spelling.oneway;
        }
    }
    return {};
}

/// Numbers the nodes. Vertices within 1e-7 degrees (1 cm) in latitude and longitude are one node,
/// at the position of the first.
class Nodes {
public:
    struct Node {
        std::int64_t number;
        GeoPoint place;
    };

    Node node_at(const GeoPoint& point) {
        const auto cell = cell_of(point);
        // A cell is twice as wide as the distance, so that all close points are in the same cell or
        // in the neighbour at the nearer border.
        const auto beyond = [](double deg, std::int64_t index) {
            return deg / cell_deg - static_cast<double>(index) < 0.5 ? index - 1 : index + 1;
        };
        for (const auto lat : {cell.lat, beyond(point.lat_deg, cell.lat)}) {
            for (const auto lon : {cell.lon, beyond(point.lon_deg, cell.lon)}) {
                const auto [first, past] = nodes_.equal_range({lat, lon});
                const auto same = std::find_if(first, past, [&](const auto& known) {
                    return are_one(known.second.place, point);
                });
                if (same != past) {
                    return same->second;
                }
            }
        }
        const Node fresh{++count_, point};
        nodes_.emplace(cell, fresh);
        return fresh;
    }

private:
    static constexpr double one_deg = 1e-7;
    static constexpr double cell_deg = 2 * one_deg;

    struct Cell {
        std::int64_t lat;
        std::int64_t lon;
        bool operator==(const Cell&) const = default;
    };
    struct Hash {
        std::size_t operator()(const Cell& cell) const {
            constexpr std::uint64_t mix = 0x9e3779b97f4a7c15; // 2^64 over the golden ratio
            return (static_cast<std::uint64_t>(cell.lat) * mix ^
                    static_cast<std::uint64_t>(cell.lon)) *
                   mix;
        }
    };

    static Cell cell_of(const GeoPoint& point) {
        return {static_cast<std::int64_t>(std::floor(point.lat_deg / cell_deg)),
                static_cast<std::int64_t>(std::floor(point.lon_deg / cell_deg))};
    }
    static bool are_one(const GeoPoint& a, const GeoPoint& b) {
        // Rounding error of degrees in doubles: one_deg itself still counts.
        constexpr double rounding = 1 + 1e-6;
        return std::abs(a.lat_deg - b.lat_deg) <= one_deg * rounding &&
               std::abs(a.lon_deg - b.lon_deg) <= one_deg * rounding;
    }

    std::unordered_multimap<Cell, Node, Hash> nodes_;
    std::int64_t count_ = 0;
};

struct Columns {
    int id;
    int name;
    int highway;
    int oneway;
};

class LayerReader {
public:
    LayerReader(const std::string& file,
                OGRLayer& layer,
                const LayerColumns& asked,
                std::uintmax_t bytes)
        : layer_{layer}, coordinates_{file, layer, bytes},
          columns_{
              .id = column(layer, asked.id, {}, file),
              .name =
                  column(layer, asked.name, {"name", "namn", "road_name", "street", "ref"}, file),
              .highway = column(layer, asked.highway, {"highway", "fclass", "road_class"}, file),
              .oneway = column(layer, asked.oneway, {"oneway", "one_way"}, file)} {}

    void read(const std::function<void(Way)>& take) {
        layer_.ResetReading();
        for (;;) {
            CPLErrorReset();
            const OGRFeatureUniquePtr feature{layer_.GetNextFeature()};
            if (!feature) {
                if (CPLGetLastErrorType() >= CE_Failure) {
                    fail(gdal_error("damaged"));
                }
                return;
            }
            read(*feature, take);
        }
    }

private:
    [[noreturn]] void fail(const std::string& what) const { coordinates_.fail(what); }

    void read(const OGRFeature& feature, const std::function<void(Way)>& take) {
        auto way = attributes_of(feature);
        const auto* const geometry = feature.GetGeometryRef();
        if (geometry == nullptr || is_for_others(way.highway)) {
            return;
        }
        const auto kind = wkbFlatten(geometry->getGeometryType());
        if (kind == wkbLineString) {
            give(way, *geometry->toLineString(), 0, take);
        } else if (kind == wkbMultiLineString) {
            std::int64_t part = 0;
            for (const auto* const line : *geometry->toMultiLineString()) {
                give(way, *line, part++, take);
            }
        }
    }

    Way attributes_of(const OGRFeature& feature) const {
        const auto oneway = text_in(feature, columns_.oneway);
        const auto parsed = parse_oneway(oneway);
        if (!parsed) {
            fail(fmt::format("feature {}: oneway is {}, expected yes, no or -1, 1 or 0, F, T or B, "
                             "FT or TF",
                             feature.GetFID(),
                             in_quotes(oneway)));
        }
        return {.id = id_of(feature),
                .name = first_of_list(text_in(feature, columns_.name)),
                .highway = first_of_list(text_in(feature, columns_.highway)),
                .oneway = *parsed,
                .node_ids = {},
                .line = {}};
    }

    std::int64_t id_of(const OGRFeature& feature) const {
        if (columns_.id < 0) {
            return feature.GetFID();
        }
        if (feature.GetFieldDefnRef(columns_.id)->GetType() == OFTReal) {
            return whole(feature.GetFieldAsDouble(columns_.id), feature);
        }
        const auto text = text_in(feature, columns_.id);
        const auto id = exact_number<std::int64_t>(text);
        if (!id) {
            refuse_id(feature);
        }
        return *id;
    }

    /// Converts an id from a real column, in which Shapefiles store long integers.
    std::int64_t whole(double id, const OGRFeature& feature) const {
        // 2^53: largest range of exact integers in a double.
        constexpr double most = 9007199254740992;
        if (!(std::abs(id) <= most && id == std::floor(id))) {
            refuse_id(feature);
        }
        return static_cast<std::int64_t>(id);
    }

    [[noreturn]] void refuse_id(const OGRFeature& feature) const {
        fail(fmt::format("feature {}: its id is {}, expected a whole number",
                         feature.GetFID(),
                         in_quotes(text_in(feature, columns_.id))));
    }

    void give(Way way,
              const OGRLineString& line,
              std::int64_t part,
              const std::function<void(Way)>& take) {
        std::int64_t beyond = 0;
        if (__builtin_mul_overflow(part, layer_part_id_step, &beyond) ||
            __builtin_add_overflow(way.id, beyond, &way.id)) {
            fail(fmt::format("feature {} has more parts than available ids", way.id));
        }
        if (!ids_.insert(way.id).second) {
            fail(fmt::format("the id {} occurs twice, expected once", way.id));
        }
        for (const auto& point : coordinates_.places_of(line)) {
            const auto node = nodes_.node_at(point);
            if (way.node_ids.empty() || way.node_ids.back() != node.number) {
                way.node_ids.push_back(node.number);
                way.line.push_back(node.place);
            }
        }
        take(std::move(way));
    }

    OGRLayer& layer_;
    LayerCoordinates coordinates_;
    Columns columns_;
    Nodes nodes_;
    std::unordered_set<std::int64_t> ids_;
};

} // namespace

} // namespace macadam

extern "C" void macadam_ogr_read_lines(const std::filesystem::path& file,
                                       const macadam::LayerColumns& columns,
                                       const std::function<void(macadam::Way)>& take) {
    const macadam::GdalErrorScope quiet;
    const auto opened = macadam::open_lines(file);
    auto& layer = macadam::layer_of(*opened.dataset, columns.layer, file.string());
    macadam::LayerReader{file.string(), layer, columns, opened.bytes}.read(take);
}
