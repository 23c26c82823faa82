#include "storage/gdal/virtual_raster.hpp"

#include "estimator/common/ascii.hpp"
#include "estimator/common/error.hpp"
#include "storage/gdal/map_kind.hpp"

#include <expat.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <memory>
#include <set>
#include <string>
#include <string_view>

namespace macadam {
namespace {

namespace fs = std::filesystem;

// In lower case: GDAL ignores case and does not distinguish attributes from elements. Elements that
// name files in other ways (raw bands, OpenOptions, warped and derived bands) are missing on
// purpose.
constexpr std::array<std::string_view, 51> known_elements{"vrtdataset",
                                                          "srs",
                                                          "geotransform",
                                                          "metadata",
                                                          "mdi",
                                                          "vrtrasterband",
                                                          "nodatavalue",
                                                          "hidenodatavalue",
                                                          "colorinterp",
                                                          "colortable",
                                                          "entry",
                                                          "description",
                                                          "unittype",
                                                          "offset",
                                                          "scale",
                                                          "categorynames",
                                                          "category",
                                                          "simplesource",
                                                          "complexsource",
                                                          "averagedsource",
                                                          "kernelfilteredsource",
                                                          "kernel",
                                                          "size",
                                                          "coefs",
                                                          "sourcefilename",
                                                          "sourceband",
                                                          "sourceproperties",
                                                          "srcrect",
                                                          "dstrect",
                                                          "nodata",
                                                          "scaleoffset",
                                                          "scaleratio",
                                                          "colortablecomponent",
                                                          "usemaskband",
                                                          "lut",
                                                          "exponent",
                                                          "srcmin",
                                                          "srcmax",
                                                          "dstmin",
                                                          "dstmax",
                                                          "maskband",
                                                          "overviewlist",
                                                          "overview",
                                                          "gcplist",
                                                          "gcp",
                                                          "histograms",
                                                          "histitem",
                                                          "histmin",
                                                          "histmax",
                                                          "bucketcount",
                                                          "histcounts"};
constexpr std::array<std::string_view, 4> more_elements{
    "includeoutofrange", "approximate", "blockxsize", "blockysize"};
constexpr std::array<std::string_view, 36> known_attributes{"rasterxsize",
                                                            "rasterysize",
                                                            "dataaxistosrsaxismapping",
                                                            "coordinateepoch",
                                                            "datatype",
                                                            "band",
                                                            "blockxsize",
                                                            "blockysize",
                                                            "subclass",
                                                            "relativetovrt",
                                                            "shared",
                                                            "resampling",
                                                            "xoff",
                                                            "yoff",
                                                            "xsize",
                                                            "ysize",
                                                            "c1",
                                                            "c2",
                                                            "c3",
                                                            "c4",
                                                            "key",
                                                            "domain",
                                                            "format",
                                                            "normalized",
                                                            "projection",
                                                            "id",
                                                            "pixel",
                                                            "line",
                                                            "x",
                                                            "y",
                                                            "z",
                                                            "info",
                                                            "mask",
                                                            "count",
                                                            "min",
                                                            "max"};

constexpr int max_depth = 4;
constexpr std::size_t max_sources = 1'000'000;
constexpr std::size_t max_bytes = 256 << 20;

template <typename Names>
bool is_in(const Names& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

/// Parses a virtual raster.
class VrtParser {
public:
    struct Source {
        std::string name;
        bool is_relative;
    };

    explicit VrtParser(const fs::path& file) : file_{file} {
        XML_SetUserData(parser_.get(), this);
        XML_SetElementHandler(parser_.get(), begin, end);
        XML_SetCharacterDataHandler(parser_.get(), text);
        XML_SetStartDoctypeDeclHandler(parser_.get(), doctype);
        XML_SetCommentHandler(parser_.get(), [](void* self, const char*) { aside(self); });
        XML_SetStartCdataSectionHandler(parser_.get(), aside);
        XML_SetProcessingInstructionHandler(
            parser_.get(), [](void* self, const char*, const char*) { aside(self); });
    }

    std::vector<Source> read() {
        std::error_code error;
        if (fs::file_size(file_, error) > max_bytes) {
            refuse("is larger than 256 MB");
        }
        std::ifstream in{file_, std::ios::binary};
        std::string chunk(1 << 16, '\0');
        while (refusal_.empty() && in) {
            in.read(chunk.data(), std::ssize(chunk));
            if (XML_Parse(parser_.get(), chunk.data(), int(in.gcount()), in ? 0 : 1) !=
                    XML_STATUS_OK &&
                refusal_.empty()) {
                refusal_ = fmt::format("is not XML: {} in line {}",
                                       XML_ErrorString(XML_GetErrorCode(parser_.get())),
                                       XML_GetCurrentLineNumber(parser_.get()));
            }
        }
        if (!refusal_.empty()) {
            refuse(refusal_);
        }
        return std::move(sources_);
    }

private:
    [[noreturn]] void refuse(const std::string& what) const {
        throw InputError{fmt::format("{}: {}, expected a virtual raster of plain files as "
                                     "gdalbuildvrt makes it",
                                     file_.string(),
                                     what)};
    }

    static VrtParser& of(void* self) { return *static_cast<VrtParser*>(self); }

    void stop(const std::string& why) {
        if (refusal_.empty()) {
            refusal_ = why;
            XML_StopParser(parser_.get(), XML_FALSE);
        }
    }

    static void begin(void* self, const char* element, const char** attributes) {
        auto& parser = of(self);
        const auto name = in_lower_case(element);
        if (parser.in_name_ || !(is_in(known_elements, name) || is_in(more_elements, name))) {
            parser.stop(fmt::format("contains the element {}", element));
        }
        bool is_relative = false;
        for (; *attributes != nullptr; attributes += 2) {
            const auto attribute = in_lower_case(attributes[0]);
            const std::string_view value = attributes[1];
            if (!is_in(known_attributes, attribute)) {
                parser.stop(fmt::format("contains the attribute {}", attributes[0]));
            } else if (attribute == "subclass" && value != "VRTSourcedRasterBand") {
                parser.stop(fmt::format("is of the kind {}", value));
            } else if (attribute == "relativetovrt" && value != "0" && value != "1") {
                parser.stop(fmt::format("has relativeToVRT {}", value));
            } else if (attribute == "relativetovrt") {
                is_relative = value == "1";
            }
        }
        if (name == "sourcefilename") {
            parser.in_name_ = true;
            parser.sources_.push_back({"", is_relative});
            if (parser.sources_.size() > max_sources) {
                parser.stop("has more than a million sources");
            }
        }
    }

    static void end(void* self, const char* /*element*/) { of(self).in_name_ = false; }

    static void text(void* self, const char* bytes, int count) {
        auto& parser = of(self);
        if (parser.in_name_) {
            parser.sources_.back().name.append(bytes, std::size_t(count));
        }
    }

    static void aside(void* self) { of(self).stop("contains a comment or processing instruction"); }

    static void doctype(void* self, const char*, const char*, const char*, int) {
        of(self).stop("declares a document type");
    }

    struct Free {
        void operator()(XML_ParserStruct* parser) const { XML_ParserFree(parser); }
    };
    fs::path file_;
    std::unique_ptr<XML_ParserStruct, Free> parser_{XML_ParserCreate(nullptr)};
    std::vector<Source> sources_;
    std::string refusal_;
    bool in_name_ = false;
};

bool is_below(const fs::path& folder, const fs::path& file) {
    return std::ranges::mismatch(folder, file).in1 == folder.end();
}

fs::path place_of(const VrtParser::Source& source, const fs::path& vrt) {
    const auto refuse = [&](const char* why) {
        throw InputError{fmt::format("{}: its source {} {}", vrt.string(), source.name, why)};
    };
    if (source.name.find(':') != std::string::npos || source.name.starts_with("/vsi")) {
        refuse("is not a plain file name, expected a file below the folder of the virtual "
               "raster");
    }
    const auto place =
        fs::absolute(source.is_relative ? vrt.parent_path() / source.name : fs::path{source.name})
            .lexically_normal();
    if (!is_below(fs::canonical(vrt.parent_path()), fs::weakly_canonical(place))) {
        refuse("is elsewhere, expected a file below the folder of the virtual raster");
    }
    if (!fs::exists(place)) {
        throw InputError{
            fmt::format("{}: cannot be read: its source {} is missing", vrt.string(), source.name)};
    }
    return place;
}

void add_sources(const fs::path& vrt, int depth, std::set<fs::path>& sources) {
    if (depth > max_depth) {
        throw InputError{fmt::format("{}: is a virtual raster nested in {} others, expected fewer",
                                     vrt.string(),
                                     depth - 1)};
    }
    for (const auto& source : VrtParser{vrt}.read()) {
        const auto place = place_of(source, vrt);
        if (!sources.insert(place).second) {
            continue;
        }
        const auto kind = kind_of_map(place);
        if (!may_hold_pictures(kind)) {
            throw InputError{fmt::format(
                "{}: its source {} is not a supported raster", vrt.string(), source.name)};
        }
        if (kind == MapKind::virtual_raster) {
            add_sources(place, depth + 1, sources);
        }
    }
}

} // namespace

std::vector<fs::path> sources_of_vrt(const fs::path& file) {
    std::set<fs::path> sources;
    const auto path = fs::absolute(file).lexically_normal();
    add_sources(path, 1, sources);
    if (sources.contains(path)) {
        throw InputError{fmt::format("{}: is a source of itself", file.string())};
    }
    return {sources.begin(), sources.end()};
}

} // namespace macadam
