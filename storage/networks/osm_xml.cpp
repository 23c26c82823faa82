#include "storage/networks/osm_objects.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/exact_number.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <osmium/io/any_compression.hpp>
#include <osmium/io/detail/read_write.hpp>

#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

/// Value of an attribute; null if it is missing.
const char* attribute(const XML_Char** attributes, std::string_view name) {
    for (; *attributes != nullptr; attributes += 2) {
        if (attributes[0] == name) {
            return attributes[1];
        }
    }
    return nullptr;
}

/// Coordinate in 1e-7 degrees; `std::nullopt` if it is invalid.
std::optional<std::int32_t> place_e7(const char* text, double max_deg) {
    const auto deg = text == nullptr ? std::nullopt : exact_number<double>(text);
    return deg && std::abs(*deg) <= max_deg
               ? std::optional{static_cast<std::int32_t>(std::lround(*deg * Unpacked::per_deg))}
               : std::nullopt;
}

/// Extracts the objects from XML that arrives in blocks.
class OsmParser {
public:
    explicit OsmParser(const OsmVisitor& visitor)
        : visitor_{visitor}, parser_{XML_ParserCreate(nullptr), XML_ParserFree} {
        XML_SetUserData(parser_.get(), this);
        XML_SetElementHandler(parser_.get(), on_start, on_end);
        XML_SetEntityDeclHandler(parser_.get(), on_entity);
    }

    void add(std::string_view bytes, bool is_last) {
        const auto status =
            XML_Parse(parser_.get(), bytes.data(), static_cast<int>(bytes.size()), is_last ? 1 : 0);
        if (refusal_) {
            throw InputError{*refusal_};
        }
        if (status == XML_STATUS_ERROR) {
            throw InputError{fmt::format("line {}: {}",
                                         XML_GetCurrentLineNumber(parser_.get()),
                                         XML_ErrorString(XML_GetErrorCode(parser_.get())))};
        }
    }

private:
    enum class Open : std::uint8_t { none, node, way, relation };

    static OsmParser& self(void* data) { return *static_cast<OsmParser*>(data); }

    /// Runs a callback. Exceptions must not pass through the C library: the parser is stopped, and
    /// `add` throws.
    template <typename Call>
    void guarded(Call call) {
        if (refusal_) {
            return;
        }
        try {
            call();
        } catch (const std::exception& error) {
            refusal_ =
                fmt::format("line {}: {}", XML_GetCurrentLineNumber(parser_.get()), error.what());
            XML_StopParser(parser_.get(), XML_FALSE);
        }
    }

    static void on_start(void* data, const XML_Char* name, const XML_Char** attributes) {
        self(data).guarded([&] { self(data).start(name, attributes); });
    }
    static void on_end(void* data, const XML_Char* name) {
        self(data).guarded([&] { self(data).end(name); });
    }
    static void on_entity(void* data,
                          const XML_Char* /*name*/,
                          int /*is_parameter*/,
                          const XML_Char* /*value*/,
                          int /*length*/,
                          const XML_Char* /*base*/,
                          const XML_Char* /*system*/,
                          const XML_Char* /*public_id*/,
                          const XML_Char* /*notation*/) {
        self(data).guarded([] { throw InputError{"declares an entity, expected none"}; });
    }

    void start(std::string_view name, const XML_Char** attributes) {
        constexpr std::size_t deepest = 64; // maps need 4
        if (++depth_ > deepest) {
            throw InputError{fmt::format("elements lie more than {} deep", deepest)};
        }
        if (depth_ == 1) {
            expect_root(name, attributes);
        } else if (name == "delete") {
            deleting_ = true;
        } else if (name == "bounds") {
            read_bounds(attributes);
        } else if (name == "node" || name == "way" || name == "relation") {
            open_ = name == "node" ? Open::node : name == "way" ? Open::way : Open::relation;
            id_ = id_in(attribute(attributes, "id"));
            tags_.clear();
            refs_.clear();
            members_.clear();
            if (open_ == Open::node) {
                read_node(attributes);
            }
        } else if (name == "nd" && open_ == Open::way && visitor_.way) {
            refs_.push_back(id_in(attribute(attributes, "ref")));
        } else if (name == "member" && open_ == Open::relation && visitor_.relation) {
            add_member(attributes);
        } else if (name == "tag" && (open_ != Open::node || visitor_.tagged_node)) {
            const char* const key = attribute(attributes, "k");
            const char* const value = attribute(attributes, "v");
            tags_.emplace_back(key == nullptr ? "" : key, value == nullptr ? "" : value);
        }
    }

    static void expect_root(std::string_view name, const XML_Char** attributes) {
        if (name != "osm" && name != "osmChange") {
            throw InputError{"its root element is not osm"};
        }
        const char* const version = attribute(attributes, "version");
        if (version == nullptr || std::string_view{version} != "0.6") {
            throw InputError{fmt::format("it is of version '{}', expected 0.6",
                                         version == nullptr ? "" : version)};
        }
    }

    static std::int64_t id_in(const char* text) {
        const auto id = text == nullptr ? std::nullopt : exact_number<std::int64_t>(text);
        if (!id) {
            throw InputError{
                fmt::format("an id is '{}', expected a whole number", text == nullptr ? "" : text)};
        }
        return *id;
    }

    void read_bounds(const XML_Char** attributes) const {
        const auto side = [&](std::string_view name) {
            const char* const text = attribute(attributes, name);
            const auto deg = text == nullptr ? std::nullopt : exact_number<double>(text);
            return deg.value_or(std::numeric_limits<double>::quiet_NaN());
        };
        give_bounds(visitor_, {side("minlon"), side("minlat"), side("maxlon"), side("maxlat")});
    }

    void read_node(const XML_Char** attributes) {
        const auto lat_e7 = place_e7(attribute(attributes, "lat"), 90);
        const auto lon_e7 = place_e7(attribute(attributes, "lon"), 180);
        place_.reset();
        if (deleting_ || !lat_e7 || !lon_e7) {
            return;
        }
        place_ = {*lat_e7, *lon_e7};
        if (visitor_.node) {
            visitor_.node(id_, *place_);
        }
    }

    void add_member(const XML_Char** attributes) {
        const char* const type = attribute(attributes, "type");
        const char* const role = attribute(attributes, "role");
        const std::string_view name = type == nullptr ? "" : type;
        if (name != "node" && name != "way" && name != "relation") {
            throw InputError{
                fmt::format("a member's type is '{}', expected node, way or relation", name)};
        }
        members_.push_back({name == "node"  ? OsmKind::node
                            : name == "way" ? OsmKind::way
                                            : OsmKind::relation,
                            id_in(attribute(attributes, "ref")),
                            role_of(role == nullptr ? "" : role)});
    }

    /// Canonical text of the few supported roles, which outlives the element.
    static std::string_view role_of(std::string_view role) {
        for (const std::string_view known : {"from", "via", "to"}) {
            if (role == known) {
                return known;
            }
        }
        return {};
    }

    void end(std::string_view name) {
        --depth_;
        const OsmTags tags = [this](const char* key) -> const char* {
            for (const auto& tag : tags_) {
                if (tag.first == key) {
                    return tag.second.c_str();
                }
            }
            return nullptr;
        };
        if (name == "delete") {
            deleting_ = false;
        } else if (name == "node" && open_ == Open::node) {
            if (visitor_.tagged_node && place_ && !tags_.empty()) {
                visitor_.tagged_node(tags, *place_);
            }
            open_ = Open::none;
        } else if (name == "way" && open_ == Open::way) {
            if (visitor_.way && !deleting_) {
                visitor_.way(id_, tags, refs_);
            }
            open_ = Open::none;
        } else if (name == "relation" && open_ == Open::relation) {
            if (visitor_.relation && !deleting_) {
                visitor_.relation(tags, members_);
            }
            open_ = Open::none;
        }
    }

    const OsmVisitor& visitor_;
    std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
    Open open_ = Open::none;
    bool deleting_ = false;
    std::size_t depth_ = 0;
    std::int64_t id_ = 0;
    std::optional<PackedPoint> place_; ///< of the current node, if valid
    std::vector<std::pair<std::string, std::string>> tags_;
    std::vector<std::int64_t> refs_;
    std::vector<OsmMember> members_;
    std::optional<std::string> refusal_;
};

osmium::io::file_compression compression_of(const std::filesystem::path& file) {
    return file.extension() == ".gz"    ? osmium::io::file_compression::gzip
           : file.extension() == ".bz2" ? osmium::io::file_compression::bzip2
                                        : osmium::io::file_compression::none;
}

} // namespace

void visit_osm_xml(const std::filesystem::path& file, const OsmVisitor& visitor) {
    const auto compression = compression_of(file);
    const auto max_bytes =
        free_xml_bytes + max_xml_expansion * std::uint64_t{std::filesystem::file_size(file)};
    std::atomic<std::size_t> consumed{0};
    const auto bytes = osmium::io::CompressionFactory::instance().create_decompressor(
        compression, osmium::io::detail::open_for_reading(file.string()));
    bytes->set_offset_ptr(&consumed);
    OsmParser parser{visitor};
    std::uint64_t unpacked = 0;
    for (bool is_last = false; !is_last;) {
        const auto piece = bytes->read();
        is_last = piece.empty();
        unpacked += piece.size();
        if (unpacked > max_bytes) {
            throw InputError{fmt::format(
                "it unpacks to more than {} times its size, which no map does", max_xml_expansion)};
        }
        parser.add(piece, is_last);
        if (visitor.pace) {
            visitor.pace(consumed);
        }
    }
    bytes->close();
}

} // namespace macadam
