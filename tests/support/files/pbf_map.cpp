#include "pbf_map.hpp"

#include <protozero/pbf_writer.hpp>
#include <zlib.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace macadam::testing {
namespace {

std::vector<std::int64_t> differences(const std::vector<std::int64_t>& values) {
    std::vector<std::int64_t> steps;
    std::uint64_t last = 0;
    for (const auto value : values) {
        steps.push_back(static_cast<std::int64_t>(static_cast<std::uint64_t>(value) - last));
        last = static_cast<std::uint64_t>(value);
    }
    return steps;
}

void add_deltas(protozero::pbf_writer& message,
                std::uint32_t tag,
                const std::vector<std::int64_t>& values) {
    const auto steps = differences(values);
    message.add_packed_sint64(tag, steps.begin(), steps.end());
}

std::string compressed(std::string_view content) {
    auto size = compressBound(content.size());
    std::string packed(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()),
                  &size,
                  reinterpret_cast<const Bytef*>(content.data()),
                  content.size(),
                  9) != Z_OK) {
        throw std::runtime_error{"zlib does not compress"};
    }
    packed.resize(size);
    return packed;
}

} // namespace

std::uint32_t PbfMap::text(const std::string& text) {
    const auto found = std::ranges::find(texts_, text);
    const auto number = static_cast<std::uint32_t>(found - texts_.begin());
    if (found == texts_.end()) {
        texts_.push_back(text);
    }
    return number;
}

PbfMap& PbfMap::nodes(const std::vector<Node>& nodes) {
    std::vector<std::int64_t> ids;
    std::vector<std::int64_t> lats;
    std::vector<std::int64_t> lons;
    for (const auto& node : nodes) {
        ids.push_back(node.id);
        lats.push_back(node.lat_e7);
        lons.push_back(node.lon_e7);
    }
    protozero::pbf_writer block{groups_};
    protozero::pbf_writer group{block, 2};
    protozero::pbf_writer dense{group, 2};
    add_deltas(dense, 1, ids);
    add_deltas(dense, 8, lats);
    add_deltas(dense, 9, lons);
    return *this;
}

PbfMap&
PbfMap::way(std::int64_t id, const std::vector<std::int64_t>& refs, const std::string& name) {
    std::vector<std::uint32_t> keys{text("highway")};
    std::vector<std::uint32_t> values{text("residential")};
    if (!name.empty()) {
        keys.push_back(text("name"));
        values.push_back(text(name));
    }
    protozero::pbf_writer block{groups_};
    protozero::pbf_writer group{block, 2};
    protozero::pbf_writer way{group, 3};
    way.add_int64(1, id);
    way.add_packed_uint32(2, keys.begin(), keys.end());
    way.add_packed_uint32(3, values.begin(), values.end());
    add_deltas(way, 8, refs);
    return *this;
}

PbfMap& PbfMap::restriction(const std::vector<std::int64_t>& from,
                            std::int64_t via,
                            const std::vector<std::int64_t>& to,
                            bool only) {
    const std::vector<std::uint32_t> keys{text("type"), text("restriction")};
    const std::vector<std::uint32_t> values{text("restriction"),
                                            text(only ? "only_straight_on" : "no_entry")};
    std::vector<std::int64_t> ids{from};
    std::vector<std::int32_t> roles(from.size(), static_cast<std::int32_t>(text("from")));
    std::vector<std::int32_t> types(from.size(), 1);
    ids.push_back(via);
    roles.push_back(static_cast<std::int32_t>(text("via")));
    types.push_back(0);
    ids.insert(ids.end(), to.begin(), to.end());
    roles.resize(ids.size(), static_cast<std::int32_t>(text("to")));
    types.resize(ids.size(), 1);
    protozero::pbf_writer block{groups_};
    protozero::pbf_writer group{block, 2};
    protozero::pbf_writer relation{group, 4};
    relation.add_int64(1, 1);
    relation.add_packed_uint32(2, keys.begin(), keys.end());
    relation.add_packed_uint32(3, values.begin(), values.end());
    relation.add_packed_int32(8, roles.begin(), roles.end());
    add_deltas(relation, 9, ids);
    relation.add_packed_int32(10, types.begin(), types.end());
    return *this;
}

PbfMap& PbfMap::end_block(Packing packing) {
    std::string content;
    {
        protozero::pbf_writer block{content};
        protozero::pbf_writer table{block, 1};
        for (const auto& each : texts_) {
            table.add_bytes(1, each);
        }
    }
    content += groups_;
    groups_.clear();
    texts_ = {""};
    return blob("OSMData", content, packing, static_cast<std::int64_t>(content.size()));
}

PbfMap& PbfMap::blob(std::string_view type,
                     std::string_view content,
                     Packing packing,
                     std::int64_t told_bytes) {
    if (file_.empty() && type != "OSMHeader") {
        std::string header;
        protozero::pbf_writer{header}.add_string(4, "OsmSchema-V0.6");
        blob("OSMHeader", header, Packing::raw, 0);
    }
    std::string packed;
    protozero::pbf_writer data{packed};
    if (packing == Packing::raw) {
        data.add_bytes(1, content.data(), content.size());
    } else {
        data.add_int32(2, static_cast<std::int32_t>(told_bytes));
        data.add_bytes(3, compressed(content));
    }
    std::string head;
    protozero::pbf_writer header{head};
    header.add_string(1, type.data(), type.size());
    header.add_int32(3, static_cast<std::int32_t>(packed.size()));
    for (int shift = 24; shift >= 0; shift -= 8) {
        file_ += static_cast<char>(head.size() >> shift & 0xffU);
    }
    file_ += head + packed;
    return *this;
}

std::string PbfMap::file() {
    if (!groups_.empty()) {
        end_block();
    }
    return file_;
}

} // namespace macadam::testing
