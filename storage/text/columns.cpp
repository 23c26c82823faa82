#include "storage/text/columns.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

using Kind = ColumnType::Kind;

std::string number_text(const ColumnType& type, double value) {
    return type.decimals == ColumnType::shortest ? fmt::format("{}", value)
                                                 : fmt::format("{:.{}f}", value, type.decimals);
}

struct PlainText {
    const ColumnType* type;

    std::string operator()(std::monostate) const { return {}; }
    std::string operator()(bool is_true) const { return is_true ? "true" : "false"; }
    std::string operator()(std::int64_t count) const { return fmt::format("{}", count); }
    std::string operator()(double value) const { return number_text(*type, value); }
    std::string operator()(const std::string& text) const { return text; }
};

struct ToJson {
    const ColumnType* type;

    JsonValue operator()(std::monostate) const { return nullptr; }
    JsonValue operator()(bool is_true) const { return is_true; }
    JsonValue operator()(std::int64_t count) const { return count; }
    JsonValue operator()(double value) const {
        return type->decimals == ColumnType::shortest
                   ? JsonValue{JsonRaw{number_text(*type, value)}}
                   : JsonValue{JsonNumber{value, type->decimals}};
    }
    JsonValue operator()(const std::string& text) const {
        return type->kind == Kind::raw ? JsonValue{JsonRaw{text}} : JsonValue{text};
    }
};

/// Tests for text that a spreadsheet would interpret as a formula, even in quotes.
bool looks_like_formula(std::string_view text) {
    return text.find_first_of("=+-@\t\r") == 0;
}

std::string quoted_cell(std::string_view text) {
    std::string cell{"\""};
    for (const char c : text) {
        cell += c == '"' ? "\"\"" : std::string(1, c);
    }
    return cell + "\"";
}

} // namespace

std::optional<std::string> plain_text(const ColumnType& type, const Cell& cell) {
    return cell.is_known() ? std::optional{std::visit(PlainText{&type}, cell.value())}
                           : std::nullopt;
}

JsonValue json_value(const ColumnType& type, const Cell& cell) {
    return std::visit(ToJson{&type}, cell.value());
}

std::string csv_cell(const ColumnType& type, const Cell& cell) {
    auto text = plain_text(type, cell).value_or("");
    return type.kind == Kind::text ? csv_text(text) : text;
}

std::string csv_text(std::string_view text) {
    if (looks_like_formula(text)) {
        return quoted_cell(fmt::format("'{}", text)); // prefix with which spreadsheets mark text
    }
    const bool plain = text.find_first_of(",\"\r\n") == std::string_view::npos;
    return plain ? std::string{text} : quoted_cell(text);
}

} // namespace macadam
