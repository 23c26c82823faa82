#include "storage/postgres/server_array.hpp"

namespace macadam {

void append_array_text(std::string& array, const std::optional<std::string_view>& text) {
    if (array.size() > 1) {
        array.push_back(',');
    }
    if (!text) {
        array += "NULL";
        return;
    }
    array += '"';
    for (const char c : *text) {
        if (c == '"' || c == '\\') {
            array += '\\';
        }
        array += c;
    }
    array += '"';
}

} // namespace macadam
