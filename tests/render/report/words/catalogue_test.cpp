#include "estimator/common/error.hpp"
#include "render/report/words/messages.hpp"
#include "render/report/words/plural_rule.hpp"
#include "render/report/words/po_file.hpp"
#include "support/files/files.hpp"
#include "support/program/places.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAreArray;

std::vector<PoEntry> shipped(const std::string& name) {
    std::ifstream stream{fs::path{testing::source_folder()} / "render/report/words" / name};
    return parse_po(std::string{std::istreambuf_iterator<char>{stream}, {}}, name);
}

template <typename Action>
std::string refusal(const Action& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing was refused";
}

/// Words that other languages take over unchanged: units, names, abbreviations.
bool is_same_in_every_language(const std::string& text) {
    return std::ranges::none_of(text, [](char c) { return 'a' <= c && c <= 'z'; }) ||
           places_in(text).size() > 0;
}

// ------------------------------------------------------------------------------------ catalogues

TEST(Catalogue, OfEveryLanguageTranslatesEveryMessageAsItStandsToday) {
    const auto english = shipped("macadam.pot");
    ASSERT_THAT(english, SizeIs(::testing::Gt(400U)));
    for (const auto* const name : {"de.po", "hu.po"}) {
        std::map<std::string, PoEntry> entries;
        for (const auto& entry : shipped(name)) {
            EXPECT_TRUE(entries.emplace(entry.context, entry).second) << name << entry.context;
        }
        EXPECT_EQ(entries.size(), english.size()) << name;
        for (const auto& message : english) {
            ASSERT_TRUE(entries.contains(message.context)) << name << ": " << message.context;
            const auto& entry = entries.at(message.context);
            EXPECT_EQ(entry.id, message.id) << name << ":" << entry.line;
            EXPECT_EQ(entry.plural_id, message.plural_id) << name << ":" << entry.line;
            EXPECT_FALSE(entry.fuzzy) << name << ":" << entry.line;
            for (const auto& text : entry.strings) {
                EXPECT_NE(text, "") << name << ":" << entry.line;
            }
        }
    }
}

TEST(Catalogue, OfEveryLanguageHasThePlacesOfTheEnglishText) {
    for (const auto* const each : languages()) {
        ASSERT_EQ(each->messages.size(), english().messages.size()) << each->code;
        for (const auto& [key, forms] : english().messages) {
            EXPECT_THAT(places_in(each->messages.at(key).back()),
                        UnorderedElementsAreArray(places_in(forms.back())))
                << each->code << ": " << key;
        }
    }
}

TEST(Catalogue, LeavesFewWordsAsTheyAreInEnglish) {
    const std::set<std::string> alike{
        "Drift", "Export", "Median", "Name", "Position", "Segment", "Trend"};
    for (const auto* const each : languages()) {
        for (const auto& [key, forms] : english().messages) {
            if (each->code != "en" && !is_same_in_every_language(forms.front()) &&
                !alike.contains(forms.front())) {
                EXPECT_NE(each->messages.at(key).front(), forms.front()) << each->code << key;
            }
        }
    }
}

TEST(Catalogue, OfALanguageMoreIsReadFromAFileWithoutABuild) {
    const auto file = testing::test_folder() / "pl.po";
    std::ofstream{file}
        << "msgid \"\"\nmsgstr \"\"\n\"Language: pl\\n\"\n"
           "\"Plural-Forms: nplurals=3; plural=(n==1 ? 0 : n%10>=2 && n%10<=4 && "
           "(n%100<10 || n%100>=20) ? 1 : 2);\\n\"\n\n"
           "msgctxt \"cars\"\nmsgid \"{count} car\"\nmsgid_plural \"{count} cars\"\n"
           "msgstr[0] \"{count} auto\"\nmsgstr[1] \"{count} auta\"\n"
           "msgstr[2] \"{count} aut\"\n\n"
           "#, fuzzy\nmsgctxt \"trips\"\nmsgid \"{count} trip\"\n"
           "msgid_plural \"{count} trips\"\nmsgstr[0] \"?\"\nmsgstr[1] \"?\"\n"
           "msgstr[2] \"?\"\n";
    const auto& polish = language_from(file);
    EXPECT_EQ(polish.code, "pl");
    const auto cars = [&](std::size_t n) {
        return say(polish, "cars", {{"count", std::to_string(n)}}, n);
    };
    EXPECT_EQ(cars(1), "1 auto");
    EXPECT_EQ(cars(3), "3 auta");
    EXPECT_EQ(cars(12), "12 aut");
    EXPECT_EQ(cars(22), "22 auta");
    // What is fuzzy or missing is said in English.
    EXPECT_EQ(say(polish, "trips", {{"count", "5"}}, 5), "5 trips");
    EXPECT_EQ(say(polish, "title"), "Road roughness");
}

TEST(Catalogue, OfALanguageMoreIsRefusedWhereItsPlacesAreWrong) {
    const auto refused = [](const std::string& entry) {
        const auto file = testing::test_folder() / "xx.po";
        std::ofstream{file} << "msgid \"\"\nmsgstr \"Plural-Forms: nplurals=1; plural=0;\\n\"\n\n"
                            << entry;
        return refusal([&] { language_from(file); });
    };
    EXPECT_THAT(refused("msgctxt \"period\"\nmsgid \"a\"\nmsgstr \"{first} {password}\"\n"),
                HasSubstr("xx.po:5: {password} is not in the English text, expected first, last"));
    EXPECT_THAT(refused("msgctxt \"period\"\nmsgid \"a\"\nmsgstr \"{first\"\n"),
                HasSubstr("xx.po:5: '{first' has a '{' without a '}'"));
    EXPECT_THAT(refused("msgctxt \"cars\"\nmsgid \"a\"\nmsgid_plural \"b\"\nmsgstr[0] \"c\"\n"
                        "msgstr[1] \"d\"\n"),
                HasSubstr("xx.po:5: 2 translations, expected 1"));
    EXPECT_THAT(refusal([] { language_from("/nowhere/xx.po"); }),
                HasSubstr("/nowhere/xx.po: cannot be read, expected a catalogue (.po)"));
    const auto pipe = testing::test_folder() / "pipe.po";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_THAT(refusal([&] { language_from(pipe); }),
                HasSubstr("pipe.po: cannot be read, expected a catalogue (.po)"));
}

// ---------------------------------------------------------------------------------------- syntax

TEST(PoFile, HasContextsPluralsContinuationsAndComments) {
    const auto entries = parse_po("# a comment\n#, fuzzy\nmsgctxt \"a\"\nmsgid \"one \"\n"
                                  "\"line\\n\"\nmsgid_plural \"more\"\nmsgstr[0] \"eine\"\n"
                                  "msgstr[1] \"\"\n\"mehrere\"\n\n#~ msgid \"old\"\n"
                                  "msgid \"\\\"b\\\\\"\nmsgstr \"c\"\r\n",
                                  "x.po");
    ASSERT_THAT(entries, SizeIs(2));
    EXPECT_EQ(entries[0].context, "a");
    EXPECT_EQ(entries[0].id, "one line\n");
    EXPECT_EQ(entries[0].plural_id, "more");
    EXPECT_THAT(entries[0].strings, ElementsAre("eine", "mehrere"));
    EXPECT_TRUE(entries[0].fuzzy);
    EXPECT_EQ(entries[0].line, 4U);
    EXPECT_EQ(entries[1].id, "\"b\\");
    EXPECT_FALSE(entries[1].fuzzy);
}

TEST(PoFile, IsRefusedWithItsLine) {
    const auto refused = [](std::string_view text) {
        return refusal([&] { parse_po(text, "x.po"); });
    };
    EXPECT_THAT(refused("msgid \"a\"\nmsgstr b\n"), HasSubstr("x.po:2: 'msgstr b', expected"));
    EXPECT_THAT(refused("msgid \"a\n"), HasSubstr("x.po:1:"));
    EXPECT_THAT(refused("\"a\"\n"), HasSubstr("x.po:1: a string without a keyword"));
    EXPECT_THAT(refused("msgstr \"a\"\n"), HasSubstr("x.po:1: 'msgstr'"));
    EXPECT_THAT(refused("msgid \"a\"\n"), HasSubstr("x.po:1: a msgid without a msgstr"));
    EXPECT_THAT(refused("msgid \"a\"\nmsgstr[1] \"b\"\n"), HasSubstr("expected msgstr[0]"));
    EXPECT_THAT(refused("msgid \"a\\\"\nmsgstr \"b\"\n"), HasSubstr("x.po:1: '\\'"));
    EXPECT_THAT(refused("msgid \"a\\x41\"\nmsgstr \"b\"\n"), HasSubstr("x.po:1: '\\x'"));
    EXPECT_THAT(refused("msgid \"\xff\"\nmsgstr \"b\"\n"), HasSubstr("not UTF-8"));
    EXPECT_THAT(refused(std::string_view{"msgid \"\x01\"\n"}), HasSubstr("control character"));
    EXPECT_THAT(refused(std::string(4'000'001, '\n')), HasSubstr("expected at most 4000000"));
}

// --------------------------------------------------------------------------------------- plurals

TEST(PluralRule, ComputesTheFormsOfGettextsManual) {
    const PluralRule russian{"nplurals=3; plural=n%10==1 && n%100!=11 ? 0 : n%10>=2 && n%10<=4 && "
                             "(n%100<10 || n%100>=20) ? 1 : 2;"};
    EXPECT_EQ(russian.form(1), 0U);
    EXPECT_EQ(russian.form(11), 2U);
    EXPECT_EQ(russian.form(21), 0U);
    EXPECT_EQ(russian.form(4), 1U);
    EXPECT_EQ(russian.form(114), 2U);
    EXPECT_EQ((PluralRule{"nplurals=1; plural=0;"}.form(7)), 0U);
    EXPECT_EQ((PluralRule{"nplurals=2; plural=!(n==1);"}.form(1)), 0U);
    EXPECT_EQ(PluralRule{}.form(0), 1U);
}

TEST(PluralRule, IsRefusedIfItGivesNoForm) {
    const auto refused = [](const std::string& text) {
        return refusal([&] { const PluralRule rule{text}; });
    };
    EXPECT_THAT(refused(""), HasSubstr("expected 'nplurals=NUMBER; plural=EXPRESSION;'"));
    EXPECT_THAT(refused("nplurals=7; plural=0;"), HasSubstr("nplurals is '7', expected 1 to 6"));
    EXPECT_THAT(refused("nplurals=2; plural=n;"), HasSubstr("no form below nplurals=2 for n = 2"));
    EXPECT_THAT(refused("nplurals=2; plural=n/0;"), HasSubstr("for n = 0"));
    EXPECT_THAT(refused("nplurals=2; plural=system(1);"), HasSubstr("plural= has 'system(1)'"));
    EXPECT_THAT(refused("nplurals=2; plural=n==;"), HasSubstr("plural= has ''"));
    EXPECT_THAT(refused("nplurals=2; plural=" + std::string(500, '(') + ";"),
                HasSubstr("nested more than 64 deep"));
    EXPECT_THAT(refused("nplurals=2; plural=" + std::string(2000, '1') + ";"),
                HasSubstr("2000 characters"));
}

} // namespace
} // namespace macadam
