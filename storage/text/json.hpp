#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace macadam {

/// Number with a fixed count of decimals.
struct JsonNumber {
    double value;
    int decimals;
};

/// JSON text that is inserted unchanged, such as an object or array built before.
struct JsonRaw {
    std::string text;
};

using JsonValue =
    std::variant<std::nullptr_t, bool, std::int64_t, JsonNumber, std::string, JsonRaw>;

/// Number, or null for `std::nullopt` and for values that are not finite.
JsonValue json_number(std::optional<double> value, int decimals);

/// Quotes and escapes `value`; bytes that are not UTF-8 are replaced.
std::string json_text(std::string_view value);

/// Builds a JSON object on one line, with its members in insertion order.
class JsonObject {
public:
    JsonObject& add(std::string_view key, JsonValue value);
    std::string text() const { return "{" + members_ + "}"; }

private:
    std::string members_;
};

std::string json_array(const std::vector<std::string>& raw_items);
std::string json_string_array(const std::vector<std::string>& strings);

} // namespace macadam
