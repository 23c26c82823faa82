// A workbook of `macadam export` as LibreOffice opens it.

#include "storage/store/road_store.hpp"
#include "support/program/program.hpp"
#include "support/program/shell.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;

TEST(LibreOffice, OpensAWorkbookWithTheValuesOfTheCsv) {
    const auto folder = fresh_folder();
    const auto store = (folder / "roads.gpkg").string();
    {
        auto world = new_store(store);
        import_trips(world, 6);
    }
    for (const auto* name : {"roads.xlsx", "roads.csv"}) {
        ASSERT_EQ(run_macadam({"export", store, "-o", (folder / name).string()}).exit_status, 0);
    }
    // The first sheet, as shown: comma, quotes, UTF-8.
    output_of(folder,
              fmt::format("soffice -env:UserInstallation=file://{0}/home --headless --convert-to "
                          "'csv:Text - txt - csv (StarCalc):44,34,76' --outdir {0}/shown "
                          "{0}/roads.xlsx",
                          folder.string()));
    const auto shown = read_file(folder / "shown/roads.csv");
    const auto csv = read_file(folder / "roads.csv");
    EXPECT_EQ(std::ranges::count(shown, '\n'), std::ranges::count(csv, '\n'));
    const auto first_row = [](const std::string& text) {
        const auto begin = text.find('\n') + 1;
        return text.substr(begin, text.find('\n', begin) - begin);
    };
    EXPECT_EQ(first_row(shown), first_row(csv));
}

} // namespace
} // namespace macadam::testing
