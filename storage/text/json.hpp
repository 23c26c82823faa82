#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace macadam {

/// A value as JSON text writes it. Numbers keep the decimals that they are given.
struct JsonNumber {
    double value;
    int decimals;
};

/// JSON text that stands as it is: an object or array made before.
struct JsonRaw {
    std::string text;
};

using JsonValue =
    std::variant<std::nullptr_t, bool, std::int64_t, JsonNumber, std::string, JsonRaw>;

/// A number, or null where there is none or it is not finite.
JsonValue json_number(std::optional<double> value, int decimals);

/// `value` quoted and escaped; bytes that are not UTF-8 are replaced.
std::string json_text(std::string_view value);

/// One JSON object on one line, its members in the order in which they were added.
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
