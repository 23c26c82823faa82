#include "xlsx_reader.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <expat.h>
#include <fmt/format.h>

#include <array>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string_view>

namespace macadam::testing {
namespace {

std::map<std::string, std::string> parts_of(const std::filesystem::path& file) {
    std::map<std::string, std::string> parts;
    const std::unique_ptr<archive, int (*)(archive*)> zip{archive_read_new(), archive_read_free};
    archive_read_support_format_zip(zip.get());
    if (archive_read_open_filename(zip.get(), file.c_str(), 1 << 16) != ARCHIVE_OK) {
        throw std::runtime_error{archive_error_string(zip.get())};
    }
    archive_entry* entry = nullptr;
    while (archive_read_next_header(zip.get(), &entry) == ARCHIVE_OK) {
        auto& text = parts[archive_entry_pathname(entry)];
        std::array<char, 1 << 14> bytes{};
        for (la_ssize_t count = 0;
             (count = archive_read_data(zip.get(), bytes.data(), bytes.size())) > 0;) {
            text.append(bytes.data(), static_cast<std::size_t>(count));
        }
    }
    return parts;
}

using Attributes = std::map<std::string, std::string>;

struct Events {
    std::function<void(const std::string&, const Attributes&)> begin;
    std::function<void(const std::string&)> end;
    std::function<void(std::string_view)> text;
};

void parse(const std::string& xml, Events events) {
    const std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser{XML_ParserCreate("UTF-8"),
                                                                         XML_ParserFree};
    XML_SetUserData(parser.get(), &events);
    XML_SetElementHandler(
        parser.get(),
        [](void* data, const char* name, const char** pairs) {
            Attributes attributes;
            for (; *pairs != nullptr; pairs += 2) {
                attributes[pairs[0]] = pairs[1];
            }
            static_cast<Events*>(data)->begin(name, attributes);
        },
        [](void* data, const char* name) { static_cast<Events*>(data)->end(name); });
    XML_SetCharacterDataHandler(parser.get(), [](void* data, const char* text, int length) {
        static_cast<Events*>(data)->text({text, static_cast<std::size_t>(length)});
    });
    if (XML_Parse(parser.get(), xml.data(), static_cast<int>(xml.size()), 1) != XML_STATUS_OK) {
        throw std::runtime_error{XML_ErrorString(XML_GetErrorCode(parser.get()))};
    }
}

std::string column_of(const std::string& reference) {
    return reference.substr(0, reference.find_first_of("0123456789"));
}

void read_rows(XlsxSheet& sheet) {
    std::string column;
    XlsxCell cell;
    bool has_value = false, in_value = false;
    parse(sheet.xml,
          {[&](const std::string& name, const Attributes& attributes) {
               if (name == "row") {
                   sheet.rows.emplace_back();
               } else if (name == "c") {
                   const auto type = attributes.find("t");
                   const auto style = attributes.find("s");
                   column = column_of(attributes.at("r"));
                   cell = {{},
                           type == attributes.end(),
                           style == attributes.end() ? 0 : std::stoi(style->second)};
                   has_value = false;
               }
               in_value = name == "v" || name == "t";
               has_value = has_value || in_value;
           },
           [&](const std::string& name) {
               in_value = false;
               if (name == "c" && has_value) {
                   sheet.rows.back()[column] = cell;
               }
           },
           [&](std::string_view text) {
               if (in_value) {
                   cell.text += text;
               }
           }});
}

} // namespace

std::vector<XlsxSheet> read_xlsx(const std::filesystem::path& file) {
    const auto parts = parts_of(file);
    std::vector<XlsxSheet> sheets;
    parse(parts.at("xl/workbook.xml"),
          {[&](const std::string& name, const Attributes& attributes) {
               if (name == "sheet") {
                   const auto part = fmt::format("xl/worksheets/sheet{}.xml", sheets.size() + 1);
                   sheets.push_back({attributes.at("name"), {}, parts.at(part)});
               }
           },
           [](const std::string&) {},
           [](std::string_view) {}});
    for (auto& sheet : sheets) {
        read_rows(sheet);
    }
    return sheets;
}

std::string part_of_xlsx(const std::filesystem::path& file, const std::string& part) {
    return parts_of(file).at(part);
}

} // namespace macadam::testing
