#include "app/cli/terminal_escape.hpp"

#include <gtest/gtest.h>

#include <string>

namespace macadam {
namespace {

TEST(Printable, LeavesWhatPeopleWriteAsItIs) {
    const std::string text = "Rue de l'Épée, 漢字, 😀\nسوق";
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, SpellsOutWhatSteersATerminal) {
    EXPECT_EQ(printable("a\x1b[31mb\x07"), "a\\x1b[31mb\\x07");
    EXPECT_EQ(printable("\x7f\t\r"), "\\x7f\\x09\\x0d");
    EXPECT_EQ(printable("\xc2\x9b"), "\\u009b"); // CSI as one letter of C1
    EXPECT_EQ(printable(std::string{"a\0b", 3}), "a\\x00b");
}

TEST(Printable, SpellsOutWhatTurnsTheDirectionOfWriting) {
    EXPECT_EQ(printable("a\xe2\x80\xae"
                        "b"),
              "a\\u202eb");
    EXPECT_EQ(printable("a\xe2\x81\xa6"), "a\\u2066");
}

TEST(Printable, SpellsOutBytesThatAreNoUtf8) {
    EXPECT_EQ(printable("a\xff\xc3("), "a\\xff\\xc3(");
    EXPECT_EQ(printable("\x9b"), "\\x9b");
}

TEST(Printable, KeepsANameOnItsLine) {
    EXPECT_EQ(printable_name("a\nimported b"), "a\\x0aimported b");
    EXPECT_EQ(printable("a\nb\n"), "a\nb\n");
}

} // namespace
} // namespace macadam
