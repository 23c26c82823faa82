#pragma once

#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace macadam::fuzz {

/// Makes spoilt inputs of good ones, the same on every machine: bits and bytes turned, blocks cut
/// out, doubled, moved or overwritten, numbers made extreme, words of the format strewn in, lines
/// exchanged, two inputs crossed, ends cut off.
class Mutation {
public:
    /// \param seeds  at least one.
    Mutation(std::vector<std::string> seeds, std::vector<std::string> words, std::uint64_t start);

    /// One of the seeds after one to four changes.
    std::string next();

private:
    std::size_t below(std::size_t past); ///< 0 for 0
    std::string_view one_of(const std::vector<std::string>& texts);
    void change(std::string& input);
    void change_bytes(std::string& input);
    void change_blocks(std::string& input);
    void change_number(std::string& input);
    void change_lines(std::string& input);

    std::vector<std::string> seeds_;
    std::vector<std::string> words_;
    std::mt19937_64 random_;
};

} // namespace macadam::fuzz
