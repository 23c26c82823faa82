#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace macadam::testing {

struct XlsxCell {
    std::string text;
    bool is_number;
    int style; ///< of styles.xml
};

struct XlsxSheet {
    std::string name;
    std::vector<std::map<std::string, XlsxCell>> rows; ///< by column: "A"; only cells with content
    std::string xml;
};

/// Reads the sheets of a workbook from its XML.
std::vector<XlsxSheet> read_xlsx(const std::filesystem::path& file);

/// Returns a file within the workbook, such as "xl/styles.xml".
std::string part_of_xlsx(const std::filesystem::path& file, const std::string& part);

} // namespace macadam::testing
