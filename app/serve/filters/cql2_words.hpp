#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// Words and signs of CQL2 text, one after the other; blanks between them are skipped.
class Cql2Words {
public:
    explicit Cql2Words(std::string_view text) : text_{text} {}

    bool is_at(char sign);

    /// Takes a sign if it is next.
    bool take(std::string_view sign);

    /// Takes a word in any case if it is next, whole.
    bool take_word(std::string_view word);

    /// Takes a name: letters, digits, _, : and . without a digit or a point at its beginning; "" if
    /// none is next.
    std::string name();

    /// Takes a name between double quotes, or text between single ones, in which '' and \' are '.
    /// \throws Cql2Error  for one that is not closed.
    std::string quoted_name();
    std::string quoted();

    /// Takes a number with or without a sign; `std::nullopt` if none is next.
    /// \throws Cql2Error  for one that is no double.
    std::optional<double> number();

    /// \throws Cql2Error  if something else is next.
    void expect(std::string_view sign);
    void expect_word(std::string_view word);
    void expect_end();

    /// Refuses what is next.
    /// \param found  was taken before
    [[noreturn]] void refuse(std::string_view expected, std::string_view found = {});

private:
    std::string_view rest();

    std::string_view text_;
    std::size_t at_ = 0;
};

} // namespace macadam
