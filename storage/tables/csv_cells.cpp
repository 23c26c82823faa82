#include "storage/tables/csv_cells.hpp"

#include "storage/text/text.hpp"

#include <algorithm>
#include <cctype>

namespace macadam {

namespace {

char lower(char letter) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
}

bool same_letters(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
        return lower(x) == lower(y);
    });
}

/// Removes a quoted cell from the front of `line`, up to its separator or the end.
std::string taken_quoted(std::string_view& line, char separator) {
    std::string cell;
    std::size_t i = 1;
    for (; i < line.size(); ++i) {
        if (line[i] != '"') {
            cell += line[i];
        } else if (i + 1 < line.size() && line[i + 1] == '"') {
            cell += line[i++];
        } else {
            break;
        }
    }
    line.remove_prefix(std::min(line.find(separator, i), line.size()));
    return std::string{trimmed(cell)};
}

std::string taken_plain(std::string_view& line, char separator) {
    const auto size = std::min(line.find(separator), line.size());
    std::string cell{trimmed(line.substr(0, size))};
    line.remove_prefix(size);
    return cell;
}

std::string_view without_leading_blanks(std::string_view line, char separator) {
    const auto first = line.find_first_not_of(separator == '\t' ? " " : " \t");
    return line.substr(std::min(first, line.size()));
}

} // namespace

std::vector<std::string> cells_of_line(std::string_view line, char separator) {
    std::vector<std::string> cells;
    line = separator == ' ' ? trimmed(line) : line; // consecutive blanks are one separator
    for (;;) {
        line = without_leading_blanks(line, separator);
        if (line.starts_with('"')) {
            cells.push_back(taken_quoted(line, separator));
        } else {
            cells.push_back(taken_plain(line, separator));
        }
        if (line.empty()) {
            return cells;
        }
        line.remove_prefix(1);
    }
}

bool fits(std::string_view text, std::string_view pattern) {
    const auto star = pattern.find('*');
    if (star == std::string_view::npos) {
        return same_letters(text, pattern);
    }
    if (text.size() < star || !same_letters(text.substr(0, star), pattern.substr(0, star))) {
        return false;
    }
    const auto rest = pattern.substr(star + 1);
    for (auto i = star; i <= text.size(); ++i) {
        if (fits(text.substr(i), rest)) {
            return true;
        }
    }
    return false;
}

std::string star_of(std::string_view text, std::string_view pattern) {
    const auto star = pattern.find('*');
    if (star == std::string_view::npos || text.size() + 1 < pattern.size()) {
        return "";
    }
    return std::string{text.substr(star, text.size() + 1 - pattern.size())};
}

} // namespace macadam
