#include "storage/text/json.hpp"

#include "storage/text/json_append.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace macadam {
namespace {

std::string text_of(const JsonNumber& number) {
    auto text = fmt::format("{:.{}f}", number.value, number.decimals);
    const bool is_zero = text.find_first_of("123456789") == std::string::npos;
    return is_zero && text.front() == '-' ? text.substr(1) : text;
}

struct TextOf {
    std::string operator()(std::nullptr_t) const { return "null"; }
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
    std::string operator()(const JsonNumber& value) const {
        return std::isfinite(value.value) ? text_of(value) : "null";
    }
    std::string operator()(const std::string& value) const { return json_text(value); }
    std::string operator()(const JsonRaw& value) const { return value.text; }
};

/// Tests for a letter that stands for itself in JSON, whatever is beside it.
bool is_plain(char letter) {
    constexpr char first = ' ', last = '~'; // of ASCII
    return letter >= first && letter <= last && letter != '"' && letter != '\\';
}

} // namespace

JsonValue json_number(std::optional<double> value, int decimals) {
    return value && std::isfinite(*value) ? JsonValue{JsonNumber{*value, decimals}}
                                          : JsonValue{nullptr};
}

std::string json_text(std::string_view value) {
    std::string text;
    append_json_text(text, value);
    return text;
}

void append_json_text(std::string& text, std::string_view value) {
    if (std::ranges::all_of(value, is_plain)) { // most texts, in a tenth of the time
        text += '"';
        text += value;
        text += '"';
    } else {
        text +=
            nlohmann::json(value).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    }
}

JsonObject& JsonObject::add(std::string_view key, JsonValue value) {
    if (!members_.empty()) {
        members_ += ',';
    }
    append_json_text(members_, key);
    members_ += ':';
    if (const auto* const raw = std::get_if<JsonRaw>(&value)) { // may be large: no copy
        members_ += raw->text;
    } else {
        members_ += std::visit(TextOf{}, value);
    }
    return *this;
}

std::string json_array(const std::vector<std::string>& raw_items) {
    std::size_t size = 2 + raw_items.size();
    for (const auto& item : raw_items) {
        size += item.size();
    }
    std::string text;
    text.reserve(size);
    text += '[';
    for (const auto& item : raw_items) {
        text += &item == &raw_items.front() ? "" : ",";
        text += item;
    }
    text += ']';
    return text;
}

std::string json_string_array(const std::vector<std::string>& strings) {
    std::vector<std::string> items;
    items.reserve(strings.size());
    for (const auto& string : strings) {
        items.push_back(json_text(string));
    }
    return json_array(items);
}

} // namespace macadam
