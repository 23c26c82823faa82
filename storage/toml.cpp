#include "storage/toml.hpp"

#include "estimator/common/error.hpp"
#include "storage/byte_stream.hpp"
#include "storage/text.hpp"

#include <fmt/core.h>

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>

namespace macadam {

struct TomlTable::Node {
    std::shared_ptr<const toml::table> file; ///< keeps `table` alive
    const toml::table* table;
    std::string name; ///< "half_car", "" at the top
    std::string file_name;

    const toml::node* get(std::string_view key) const { return table->get(key); }

    const toml::node& at(std::string_view key) const {
        const auto* const node = get(key);
        if (node == nullptr) {
            throw InputError{fmt::format("{}: the key {} is missing", place(*table), full(key))};
        }
        return *node;
    }

    std::string place(const toml::source_region& source) const {
        return fmt::format("{}:{}", file_name, std::max(source.begin.line, 1U));
    }
    std::string place(const toml::node& node) const { return place(node.source()); }

    std::string full(std::string_view key) const {
        return name.empty() ? fmt::format("'{}'", key) : fmt::format("'{}.{}'", name, key);
    }

    TomlTable child(const toml::table& of, std::string_view key) const {
        return TomlTable{std::make_shared<const Node>(
            Node{.file = file, .table = &of, .name = std::string{key}, .file_name = file_name})};
    }
};

namespace {

std::string shown(const toml::node& node) {
    if (const auto text = node.value_exact<std::string>()) {
        return in_quotes(*text);
    }
    if (const auto number = node.value<double>(); number && node.is_number()) {
        return fmt::format("'{}'", *number);
    }
    if (const auto flag = node.value_exact<bool>()) {
        return *flag ? "'true'" : "'false'";
    }
    return node.is_table() ? "a table" : node.is_array() ? "an array" : "a date";
}

[[noreturn]] void fail(const TomlTable::Node& table,
                       std::string_view key,
                       const toml::node& node,
                       std::string_view expected) {
    throw InputError{fmt::format(
        "{}: {} is {}, expected {}", table.place(node), table.full(key), shown(node), expected)};
}

std::optional<double> number_of(const toml::node& node, const TomlRange& range) {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    return value && std::isfinite(*value) && range.holds(*value) ? value : std::nullopt;
}

TomlTable top_of(std::string_view text, const std::string& name) {
    try {
        auto table = std::make_shared<const toml::table>(toml::parse(text, name));
        const auto* const top = table.get();
        return TomlTable{std::make_shared<const TomlTable::Node>(TomlTable::Node{
            .file = std::move(table), .table = top, .name = "", .file_name = name})};
    } catch (const toml::parse_error& error) {
        throw InputError{fmt::format(
            "{}:{}: {}", name, std::max(error.source().begin.line, 1U), error.description())};
    }
}

} // namespace

TomlTable::TomlTable(std::shared_ptr<const Node> node) : node_{std::move(node)} {}

bool TomlTable::has(std::string_view key) const {
    return node_->get(key) != nullptr;
}

std::vector<std::string> TomlTable::keys() const {
    std::vector<std::string> names;
    for (const auto& [key, node] : *node_->table) {
        names.emplace_back(key.str());
    }
    return names;
}

double TomlTable::number(std::string_view key, const TomlRange& range) const {
    const auto& node = node_->at(key);
    const auto value = number_of(node, range);
    if (!value) {
        fail(*node_, key, node, range.words);
    }
    return *value;
}

std::int64_t TomlTable::integer(std::string_view key, std::int64_t low, std::int64_t high) const {
    const auto& node = node_->at(key);
    const auto value = node.value_exact<std::int64_t>();
    if (!value || *value < low || *value > high) {
        fail(*node_, key, node, fmt::format("a whole number from {} to {}", low, high));
    }
    return *value;
}

bool TomlTable::flag(std::string_view key) const {
    const auto& node = node_->at(key);
    const auto value = node.value_exact<bool>();
    if (!value) {
        fail(*node_, key, node, "true or false");
    }
    return *value;
}

std::string TomlTable::text(std::string_view key) const {
    auto value = text_or_empty(key);
    if (value.empty()) {
        fail(*node_, key, node_->at(key), "a text");
    }
    return value;
}

std::string TomlTable::text_or_empty(std::string_view key) const {
    const auto& node = node_->at(key);
    auto value = node.value_exact<std::string>();
    if (!value) {
        fail(*node_, key, node, "a text");
    }
    return *std::move(value);
}

std::vector<double> TomlTable::numbers(std::string_view key, const TomlRange& range) const {
    const auto& node = node_->at(key);
    const auto expected = fmt::format("an array, each {}", range.words);
    if (!node.is_array()) {
        fail(*node_, key, node, expected);
    }
    std::vector<double> values;
    for (const auto& element : *node.as_array()) {
        const auto value = number_of(element, range);
        if (!value) {
            fail(*node_, key, element, expected);
        }
        values.push_back(*value);
    }
    return values;
}

std::vector<std::string> TomlTable::texts(std::string_view key) const {
    const auto& node = node_->at(key);
    if (!node.is_array()) {
        fail(*node_, key, node, "an array of texts");
    }
    std::vector<std::string> values;
    for (const auto& element : *node.as_array()) {
        auto value = element.value_exact<std::string>();
        if (!value) {
            fail(*node_, key, element, "an array of texts");
        }
        values.push_back(*std::move(value));
    }
    return values;
}

std::optional<double> TomlTable::maybe_number(std::string_view key, const TomlRange& range) const {
    return has(key) ? std::optional{number(key, range)} : std::nullopt;
}

std::optional<std::string> TomlTable::maybe_text(std::string_view key) const {
    return has(key) ? std::optional{text(key)} : std::nullopt;
}

std::optional<bool> TomlTable::maybe_flag(std::string_view key) const {
    return has(key) ? std::optional{flag(key)} : std::nullopt;
}

bool TomlTable::is_text(std::string_view key) const {
    return has(key) && node_->at(key).is_string();
}

bool TomlTable::is_number(std::string_view key) const {
    return has(key) && node_->at(key).is_number();
}

std::optional<TomlTable> TomlTable::table(std::string_view key) const {
    const auto* const node = node_->get(key);
    if (node == nullptr) {
        return {};
    }
    if (!node->is_table()) {
        throw InputError{fmt::format(
            "{}: '{}' is {}, expected [{}]", node_->place(*node), key, shown(*node), key)};
    }
    return node_->child(*node->as_table(), key);
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
    const auto* const node = node_->get(key);
    if (node == nullptr) {
        return {};
    }
    const auto* const array = node->as_array();
    if (array == nullptr || !array->is_homogeneous(toml::node_type::table)) {
        throw InputError{fmt::format(
            "{}: '{}' is {}, expected [[{}]]", node_->place(*node), key, shown(*node), key)};
    }
    std::vector<TomlTable> all;
    for (const auto& element : *array) {
        all.push_back(node_->child(*element.as_table(), key));
    }
    return all;
}

std::string TomlTable::where(std::string_view key) const {
    const auto* const node = node_->get(key);
    return node_->place(node == nullptr ? *node_->table : *node);
}

void TomlTable::expect_only(std::span<const std::string_view> known) const {
    for (const auto& key : keys()) {
        if (std::ranges::find(known, key) == known.end()) {
            refuse_unknown(key);
        }
    }
}

void TomlTable::refuse_unknown(std::string_view key) const {
    for (const auto& [name, node] : *node_->table) {
        if (name.str() == key) {
            throw InputError{fmt::format("{}: the key {} is not known (docs/formats.md lists them)",
                                         node_->place(name.source()),
                                         node_->full(key))};
        }
    }
    miss(key);
}

void TomlTable::miss(std::string_view key) const {
    throw InputError{
        fmt::format("{}: the key {} is missing", node_->place(*node_->table), node_->full(key))};
}

void TomlTable::refuse(std::string_view key, std::string_view expected) const {
    fail(*node_, key, node_->at(key), expected);
}

TomlTable read_toml(const std::filesystem::path& file, std::string_view what) {
    constexpr std::size_t most_bytes = 1 << 20; // settings take some thousands
    std::string text(most_bytes, '\0');
    std::size_t size = 0;
    const auto bytes = file_bytes(file);
    while (const auto count = bytes->read(std::span{text}.subspan(size))) {
        size += count;
    }
    if (size == most_bytes) {
        throw InputError{fmt::format("{}: is larger than 1 MiB, expected {}", file.string(), what)};
    }
    text.resize(size);
    return top_of(text, file.string());
}

TomlTable parse_toml(std::string_view text, const std::string& name) {
    return top_of(text, name);
}

} // namespace macadam
