#include "vector_tile_reader.hpp"

#include <protozero/pbf_reader.hpp>

#include <stdexcept>

namespace macadam::testing {
namespace {

void require(bool holds, const char* what) {
    if (!holds) {
        throw std::runtime_error{what};
    }
}

TileValue value_in(protozero::pbf_reader value) {
    require(value.next(), "an empty value");
    switch (value.tag()) {
    case 1:
        return value.get_string();
    case 3:
        return value.get_double();
    case 6:
        return value.get_sint64();
    default:
        throw std::runtime_error{"a value of a kind that we do not write"};
    }
}

int unzigzagged(std::uint32_t value) {
    return static_cast<int>(value >> 1U) ^ -static_cast<int>(value & 1U);
}

/// 4.3: a line string is MoveTo of one place and LineTo of at least one, none of length 0.
std::vector<std::vector<std::pair<int, int>>> lines_in(const std::vector<std::uint32_t>& words) {
    std::vector<std::vector<std::pair<int, int>>> lines;
    int x = 0, y = 0;
    for (std::size_t at = 0; at < words.size();) {
        const auto command = words[at] & 7U, count = words[at] >> 3U;
        ++at;
        require(lines.empty() ? command == 1 : true, "begins without MoveTo");
        require(command == 1 ? count == 1 : command == 2 && count > 0, "no line string");
        require(command == 1 ? lines.empty() || lines.back().size() > 1 : lines.back().size() == 1,
                "MoveTo and LineTo do not take turns");
        if (command == 1) {
            lines.emplace_back();
        }
        for (std::uint32_t i = 0; i < count; ++i, at += 2) {
            const int dx = unzigzagged(words.at(at)), dy = unzigzagged(words.at(at + 1));
            require(command == 1 || dx != 0 || dy != 0, "a LineTo of length 0");
            x += dx;
            y += dy;
            lines.back().emplace_back(x, y);
        }
    }
    require(!lines.empty() && lines.back().size() > 1, "ends with MoveTo");
    return lines;
}

struct RawFeature {
    std::optional<std::uint64_t> id;
    std::vector<std::uint32_t> tags, geometry;
};

RawFeature raw_feature_in(protozero::pbf_reader reader) {
    RawFeature feature;
    while (reader.next()) {
        if (reader.tag() == 1) {
            feature.id = reader.get_uint64();
        } else if (reader.tag() == 2) {
            for (const auto tag : reader.get_packed_uint32()) {
                feature.tags.push_back(tag);
            }
        } else if (reader.tag() == 3) {
            require(reader.get_enum() == 2, "no line string");
        } else if (reader.tag() == 4) {
            for (const auto word : reader.get_packed_uint32()) {
                feature.geometry.push_back(word);
            }
        } else {
            throw std::runtime_error{"a part of a feature that the specification does not know"};
        }
    }
    return feature;
}

} // namespace

ReadTile read_vector_tile(std::string_view bytes) {
    protozero::pbf_reader tile{bytes.data(), bytes.size()};
    require(tile.next() && tile.tag() == 3, "no layer");
    auto layer = tile.get_message();
    require(!tile.next(), "more than one layer");
    ReadTile read;
    std::vector<RawFeature> features;
    while (layer.next()) {
        switch (layer.tag()) {
        case 1:
            read.layer = layer.get_string();
            break;
        case 2:
            features.push_back(raw_feature_in(layer.get_message()));
            break;
        case 3:
            read.keys.push_back(layer.get_string());
            break;
        case 4:
            read.values.push_back(value_in(layer.get_message()));
            break;
        case 5:
            read.extent = layer.get_uint32();
            break;
        case 15:
            read.version = layer.get_uint32();
            break;
        default:
            throw std::runtime_error{"a part of a layer that the specification does not know"};
        }
    }
    for (const auto& raw : features) {
        auto& feature = read.features.emplace_back();
        feature.id = raw.id;
        require(raw.tags.size() % 2 == 0, "a key without a value");
        for (std::size_t i = 0; i < raw.tags.size(); i += 2) {
            const bool is_new =
                feature.values.emplace(read.keys.at(raw.tags[i]), read.values.at(raw.tags[i + 1]))
                    .second;
            require(is_new, "a key twice");
        }
        feature.lines = lines_in(raw.geometry);
    }
    return read;
}

} // namespace macadam::testing
