#include "storage/profiles/fixed_fields.hpp"

#include <gmock/gmock.h>

#include <string>

using namespace macadam;
using ::testing::IsEmpty;

namespace {

std::string text_of(std::string_view format) {
    std::string text;
    for (const auto& [from, width, decimals] : fields_of_format(format)) {
        text += std::to_string(from) + "+" + std::to_string(width) + "." +
                std::to_string(decimals) + " ";
    }
    return text;
}

} // namespace

TEST(FixedFields, AreThoseOfTheFormat) {
    EXPECT_EQ(text_of("(2F8.3)"), "0+8.3 8+8.3 ");
    EXPECT_EQ(text_of("(1X,F8.3,2X,I6)"), "1+8.3 11+6.0 ");
    EXPECT_EQ(text_of(" ( 2( 1x, e12.4e3 ) , G14.6 ) "), "1+12.4 14+12.4 26+14.6 ");
    EXPECT_EQ(text_of("(1P2D10.2)"), "0+10.2 10+10.2 ");
    EXPECT_EQ(text_of("(ES9.2,EN9.2)"), "0+9.2 9+9.2 ");
    EXPECT_EQ(text_of("4F6.1"), "0+6.1 6+6.1 12+6.1 18+6.1 ");
}

TEST(FixedFields, AreNoneOfAFormatThatIsNotUnderstood) {
    for (const char* const format : {"",
                                     "*",
                                     "(A8)",
                                     "(F)",
                                     "(F8.9)",
                                     "(2F8.3",
                                     "(F8.3))",
                                     "(9999(9999F8.3))",
                                     "(9999(9999(9999X)))",
                                     "(0(F8.3))",
                                     "(99999999999999999999F8.3)",
                                     "(9999())",
                                     "((((((((((((((((((((((((F8.3))))))))))))))))))))))))"}) {
        EXPECT_THAT(fields_of_format(format), IsEmpty()) << format;
    }
}

TEST(FortranNumber, HasItsPointWhereTheFormatPutsIt) {
    EXPECT_EQ(fortran_number(" 12345", 3), 12.345);
    EXPECT_EQ(fortran_number("-12.5", 3), -12.5);
    EXPECT_EQ(fortran_number("1.5D2"), 150);
    EXPECT_EQ(fortran_number("1d-2", 3), 0.01);
    EXPECT_FALSE(fortran_number("****"));
    EXPECT_FALSE(fortran_number(""));
    EXPECT_FALSE(fortran_number("nan"));
}
