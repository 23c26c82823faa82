#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

namespace macadam {

/// Plural rule of a language, as gettext writes it in a catalogue:
/// "nplurals=3; plural=(n==1 ? 0 : n%10>=2 && n%10<=4 ? 1 : 2);", an expression of C over n with
/// `? : || && == != < <= > >= + - * / % !`, numbers and brackets.
///
/// Source: GNU gettext manual 0.21, section 11.2.6.
class PluralRule {
public:
    /// Rule of English: 1 is form 0, everything else is form 1.
    PluralRule();

    /// \throws InputError  unless the text is a rule of 1 to 6 forms whose expression is shorter
    ///                     than 1000 characters and gives one of the forms for every n to 1000.
    explicit PluralRule(std::string_view text);

    std::size_t forms() const { return forms_; }

    /// Returns the form for a count: less than forms().
    std::size_t form(std::size_t count) const;

    struct Node;

private:
    std::size_t forms_ = 0;
    std::shared_ptr<const Node> root_;
};

} // namespace macadam
