#include "storage/networks/osm_objects.hpp"

#include "estimator/common/error.hpp"
#include "storage/networks/osm_blobs.hpp"
#include "storage/networks/pbf_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using Bytes = std::string_view;

// Source of tags and types: OSM wiki, page PBF Format; osmformat.proto.

enum class HeaderBlock : protozero::pbf_tag_type { bounds = 1, required_features = 4 };
enum class Bounds : protozero::pbf_tag_type { west = 1, east = 2, north = 3, south = 4 };
enum class Block : protozero::pbf_tag_type {
    string_table = 1,
    group = 2,
    granularity = 17,
    lat_offset = 19,
    lon_offset = 20
};
enum class StringTable : protozero::pbf_tag_type { text = 1 };
enum class Group : protozero::pbf_tag_type { node = 1, dense = 2, way = 3, relation = 4 };
enum class Node : protozero::pbf_tag_type { id = 1, lat = 8, lon = 9 };
enum class Dense : protozero::pbf_tag_type { id = 1, lat = 8, lon = 9, keys_values = 10 };
enum class Object : protozero::pbf_tag_type { id = 1, keys = 2, values = 3 };
enum class WayRefs : protozero::pbf_tag_type { refs = 8 };
enum class Members : protozero::pbf_tag_type { roles = 8, ids = 9, types = 10 };

[[noreturn]] void fail(const std::string& what) {
    throw InputError{what};
}

GeoBox read_bounds(Bytes bytes) {
    constexpr double nano_per_deg = 1e9;
    auto bounds = pbf_message<Bounds>(bytes);
    GeoBox box;
    while (bounds.next()) {
        switch (bounds.tag_and_type()) {
        case number_field(Bounds::west):
            box.west_deg = double(bounds.get_sint64()) / nano_per_deg;
            break;
        case number_field(Bounds::east):
            box.east_deg = double(bounds.get_sint64()) / nano_per_deg;
            break;
        case number_field(Bounds::north):
            box.north_deg = double(bounds.get_sint64()) / nano_per_deg;
            break;
        case number_field(Bounds::south):
            box.south_deg = double(bounds.get_sint64()) / nano_per_deg;
            break;
        default:
            bounds.skip();
        }
    }
    return box;
}

void read_header(Bytes bytes, const OsmVisitor& visitor) {
    auto header = pbf_message<HeaderBlock>(bytes);
    while (header.next()) {
        if (header.tag_and_type() == bytes_field(HeaderBlock::bounds)) {
            give_bounds(visitor, read_bounds(bytes_of(header.get_view())));
            continue;
        }
        if (header.tag_and_type() != bytes_field(HeaderBlock::required_features)) {
            header.skip();
            continue;
        }
        const auto feature = bytes_of(header.get_view());
        if (feature != "OsmSchema-V0.6" && feature != "DenseNodes") {
            fail(fmt::format("it needs the feature '{}', expected a plain map", feature));
        }
    }
}

// -------------------------------------------------------------------------------------- blocks

/// String table of a block, with each text terminated by zero.
class Texts {
public:
    void read(Bytes bytes) {
        auto table = pbf_message<StringTable>(bytes);
        while (table.next()) {
            if (table.tag_and_type() != bytes_field(StringTable::text)) {
                table.skip();
                continue;
            }
            first_.push_back(static_cast<std::uint32_t>(letters_.size())); // at most 64 MiB
            letters_ += bytes_of(table.get_view());
            letters_ += '\0';
        }
    }

    void clear() {
        letters_.clear();
        first_.clear();
    }

    const char* at(std::uint64_t number) const {
        if (number >= first_.size()) {
            fail(fmt::format("text {} of a block of {}", number, first_.size()));
        }
        return letters_.data() + first_[number];
    }

private:
    std::string letters_;
    std::vector<std::uint32_t> first_;
};

/// Decodes delta-coded ids and positions. Overflow wraps around, because the input is untrusted.
class Running {
public:
    std::int64_t add(std::int64_t difference) {
        sum_ += static_cast<std::uint64_t>(difference);
        return static_cast<std::int64_t>(sum_);
    }

private:
    std::uint64_t sum_ = 0;
};

class BlockReader {
public:
    explicit BlockReader(const OsmVisitor& visitor) : visitor_{visitor} {}

    void read(Bytes bytes) {
        read_head(bytes);
        auto block = pbf_message<Block>(bytes);
        while (block.next(Block::group, protozero::pbf_wire_type::length_delimited)) {
            read_group(bytes_of(block.get_view()));
        }
    }

private:
    using Packed = protozero::iterator_range<protozero::const_varint_iterator<std::uint32_t>>;
    using Deltas = protozero::iterator_range<protozero::const_svarint_iterator<std::int64_t>>;

    void read_head(Bytes bytes) {
        texts_.clear();
        granularity_ = 100;
        lat_offset_ = 0;
        lon_offset_ = 0;
        auto block = pbf_message<Block>(bytes);
        while (block.next()) {
            switch (block.tag_and_type()) {
            case bytes_field(Block::string_table):
                texts_.read(bytes_of(block.get_view()));
                break;
            case number_field(Block::granularity):
                granularity_ = block.get_int32();
                break;
            case number_field(Block::lat_offset):
                lat_offset_ = block.get_int64();
                break;
            case number_field(Block::lon_offset):
                lon_offset_ = block.get_int64();
                break;
            default:
                block.skip();
            }
        }
    }

    void read_group(Bytes bytes) {
        auto group = pbf_message<Group>(bytes);
        while (group.next()) {
            const bool wants_nodes = visitor_.node || visitor_.tagged_node;
            const bool nodes = group.tag_and_type() == bytes_field(Group::node) && wants_nodes;
            const bool dense = group.tag_and_type() == bytes_field(Group::dense) && wants_nodes;
            const bool way = group.tag_and_type() == bytes_field(Group::way) && visitor_.way;
            const bool relation =
                group.tag_and_type() == bytes_field(Group::relation) && visitor_.relation;
            if (nodes) {
                read_node(bytes_of(group.get_view()));
            } else if (dense) {
                read_dense(bytes_of(group.get_view()));
            } else if (way) {
                read_way(bytes_of(group.get_view()));
            } else if (relation) {
                read_relation(bytes_of(group.get_view()));
            } else {
                group.skip();
            }
        }
    }

    void read_node(Bytes bytes) {
        auto node = pbf_message<Node>(bytes);
        std::int64_t id = 0;
        std::int64_t lat = 0;
        std::int64_t lon = 0;
        Tags tags;
        while (node.next()) {
            switch (node.tag_and_type()) {
            case number_field(Node::id):
                id = node.get_sint64();
                break;
            case number_field(Node::lat):
                lat = node.get_sint64();
                break;
            case number_field(Node::lon):
                lon = node.get_sint64();
                break;
            case bytes_field(Object::keys):
                tags.keys = node.get_packed_uint32();
                break;
            case bytes_field(Object::values):
                tags.values = node.get_packed_uint32();
                break;
            default:
                node.skip();
            }
        }
        tags_.clear();
        if (visitor_.tagged_node) {
            read_tags(tags);
        }
        give_node(id, lat, lon);
    }

    void read_dense(Bytes bytes) {
        auto dense = pbf_message<Dense>(bytes);
        Deltas ids;
        Deltas lats;
        Deltas lons;
        Packed keys_values;
        while (dense.next()) {
            switch (dense.tag_and_type()) {
            case bytes_field(Dense::id):
                ids = dense.get_packed_sint64();
                break;
            case bytes_field(Dense::lat):
                lats = dense.get_packed_sint64();
                break;
            case bytes_field(Dense::lon):
                lons = dense.get_packed_sint64();
                break;
            case bytes_field(Dense::keys_values):
                keys_values = dense.get_packed_uint32();
                break;
            default:
                dense.skip();
            }
        }
        Running id;
        Running lat;
        Running lon;
        while (!ids.empty()) {
            if (lats.empty() || lons.empty()) {
                fail("a block has more nodes than coordinates");
            }
            const auto at_lat = lat.add(lats.front());
            const auto at_lon = lon.add(lons.front());
            tags_.clear();
            if (visitor_.tagged_node) {
                read_tags_of_dense_node(keys_values);
            }
            give_node(id.add(ids.front()), at_lat, at_lon);
            ids.drop_front();
            lats.drop_front();
            lons.drop_front();
        }
    }

    /// Position in 1e-7 degrees; `std::nullopt` if it is invalid.
    std::optional<std::int32_t>
    place_e7(std::int64_t steps, std::int64_t offset, std::int64_t max_deg) const {
        constexpr std::int64_t nano_per_e7 = 100;
        constexpr std::int64_t e7_per_deg = 10'000'000;
        std::int64_t nano_deg = 0;
        if (__builtin_mul_overflow(steps, std::int64_t{granularity_}, &nano_deg) ||
            __builtin_add_overflow(nano_deg, offset, &nano_deg)) {
            return {};
        }
        const auto e7 = nano_deg / nano_per_e7;
        return e7 >= -max_deg * e7_per_deg && e7 <= max_deg * e7_per_deg
                   ? std::optional{static_cast<std::int32_t>(e7)}
                   : std::nullopt;
    }

    /// Gives a node, whose tags were read.
    void give_node(std::int64_t id, std::int64_t lat, std::int64_t lon) {
        const auto lat_e7 = place_e7(lat, lat_offset_, 90);
        const auto lon_e7 = place_e7(lon, lon_offset_, 180);
        if (!lat_e7 || !lon_e7) {
            return;
        }
        if (visitor_.node) {
            visitor_.node(id, {*lat_e7, *lon_e7});
        }
        if (!tags_.empty()) {
            visitor_.tagged_node(look_up(), {*lat_e7, *lon_e7});
        }
    }

    /// Keys and values of an object, as indexes into the string table.
    struct Tags {
        Packed keys;
        Packed values;
    };

    /// Reads the tags of the next node of a block: keys and values in turn, then 0.
    void read_tags_of_dense_node(Packed& keys_values) {
        while (!keys_values.empty()) {
            const auto key = keys_values.front();
            keys_values.drop_front();
            if (key == 0) {
                return;
            }
            if (keys_values.empty()) {
                fail("a node has different numbers of keys and values");
            }
            tags_.emplace_back(texts_.at(key), texts_.at(keys_values.front()));
            keys_values.drop_front();
        }
    }

    OsmTags tags_of(const Tags& tags) {
        read_tags(tags);
        return look_up();
    }

    /// Reads the tags; there must be as many keys as values, all in the string table.
    void read_tags(const Tags& tags) {
        tags_.clear();
        auto [keys, values] = tags;
        for (; !keys.empty() && !values.empty(); keys.drop_front(), values.drop_front()) {
            tags_.emplace_back(texts_.at(keys.front()), texts_.at(values.front()));
        }
        if (!keys.empty() || !values.empty()) {
            fail("an object has different numbers of keys and values");
        }
    }

    OsmTags look_up() const {
        return [this](const char* key) -> const char* {
            const auto found = std::ranges::find(tags_, std::string_view{key}, [](const auto& tag) {
                return std::string_view{tag.first};
            });
            return found == tags_.end() ? nullptr : found->second;
        };
    }

    void read_way(Bytes bytes) {
        auto way = protozero::pbf_reader{bytes.data(), bytes.size()};
        std::int64_t id = 0;
        Tags tags;
        Deltas refs;
        while (way.next()) {
            switch (way.tag_and_type()) {
            case number_field(Object::id):
                id = way.get_int64();
                break;
            case bytes_field(Object::keys):
                tags.keys = way.get_packed_uint32();
                break;
            case bytes_field(Object::values):
                tags.values = way.get_packed_uint32();
                break;
            case bytes_field(WayRefs::refs):
                refs = way.get_packed_sint64();
                break;
            default:
                way.skip();
            }
        }
        refs_.clear();
        Running ref;
        for (const auto difference : refs) {
            refs_.push_back(ref.add(difference));
        }
        visitor_.way(id, tags_of(tags), refs_);
    }

    void read_relation(Bytes bytes) {
        auto relation = protozero::pbf_reader{bytes.data(), bytes.size()};
        Tags tags;
        protozero::iterator_range<protozero::const_varint_iterator<std::int32_t>> roles;
        protozero::iterator_range<protozero::const_varint_iterator<std::int32_t>> types;
        Deltas ids;
        while (relation.next()) {
            switch (relation.tag_and_type()) {
            case bytes_field(Object::keys):
                tags.keys = relation.get_packed_uint32();
                break;
            case bytes_field(Object::values):
                tags.values = relation.get_packed_uint32();
                break;
            case bytes_field(Members::roles):
                roles = relation.get_packed_int32();
                break;
            case bytes_field(Members::ids):
                ids = relation.get_packed_sint64();
                break;
            case bytes_field(Members::types):
                types = relation.get_packed_enum();
                break;
            default:
                relation.skip();
            }
        }
        members_.clear();
        Running id;
        for (; !ids.empty(); ids.drop_front(), roles.drop_front(), types.drop_front()) {
            if (roles.empty() || types.empty()) {
                fail("a relation has more members than roles or types");
            }
            members_.push_back({kind_of(types.front()),
                                id.add(ids.front()),
                                texts_.at(static_cast<std::uint32_t>(roles.front()))});
        }
        visitor_.relation(tags_of(tags), members_);
    }

    static OsmKind kind_of(std::int32_t type) {
        if (type < 0 || type > 2) {
            fail(fmt::format("a relation's member of type {}, expected 0, 1 or 2", type));
        }
        return static_cast<OsmKind>(type);
    }

    const OsmVisitor& visitor_;
    Texts texts_;
    std::int32_t granularity_ = 100; ///< nanodegrees
    std::int64_t lat_offset_ = 0;
    std::int64_t lon_offset_ = 0;
    std::vector<std::pair<const char*, const char*>> tags_; ///< of the current object
    std::vector<std::int64_t> refs_;
    std::vector<OsmMember> members_;
};

} // namespace

void visit_osm_pbf(const std::filesystem::path& file, const OsmVisitor& visitor) {
    OsmBlobs blobs{file};
    BlockReader reader{visitor};
    bool has_header = false;
    while (const auto blob = blobs.next()) {
        if (!has_header && blob->type != "OSMHeader") {
            fail("its first blob is not a map header");
        }
        if (blob->type == "OSMHeader") {
            read_header(blob->content, visitor);
            has_header = true;
        } else if (blob->type == "OSMData") {
            reader.read(blob->content);
        }
        if (visitor.pace) {
            visitor.pace(blobs.consumed());
        }
    }
    if (!has_header) {
        fail("it is empty");
    }
}

} // namespace macadam
