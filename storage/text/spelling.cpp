#include "storage/text/spelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace macadam {
namespace {

/// Counts the edits between two words: insertions, deletions, substitutions and transpositions
/// (optimal string alignment distance).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before_last;
    std::vector<std::size_t> last(b.size() + 1);
    std::iota(last.begin(), last.end(), 0U);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::vector<std::size_t> row{i};
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row.push_back(std::min({changed, last[j] + 1, row[j - 1] + 1}));
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = std::min(row[j], before_last[j - 2] + 1);
            }
        }
        before_last = std::exchange(last, std::move(row));
    }
    return last.back();
}

} // namespace

std::string nearest_word(std::string_view misspelled, std::span<const std::string> known) {
    constexpr std::size_t max_word = 64; // a file name of any length costs no time
    if (misspelled.size() > max_word) {
        return "";
    }
    std::size_t fewest = (misspelled.size() > 6 ? 2 : 1) + 1;
    std::string nearest;
    for (const auto& word : known) {
        if (const auto edits = edit_distance(misspelled, word); edits < fewest) {
            fewest = edits;
            nearest = word;
        }
    }
    return nearest;
}

std::string suggestion(std::string_view misspelled, std::span<const std::string> known) {
    const auto word = nearest_word(misspelled, known);
    return word.empty() ? "" : fmt::format("; did you mean {}?", word);
}

} // namespace macadam
