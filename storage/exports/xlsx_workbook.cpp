#include "storage/exports/xlsx_workbook.hpp"

#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_file_set.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <xlsxwriter.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

using Kind = ColumnType::Kind;

constexpr std::size_t max_text_bytes = 32'767;  // of a cell of Excel, in letters; bytes are more
constexpr std::int64_t oldest_s = 315'532'800;  // 1980-01-01: the first day of ZIP
constexpr double min_width = 8, max_width = 40; // of a column, in letters

/// Returns the number format of a column: "0.000".
std::string format_of(const ColumnType& type) {
    switch (type.kind) {
    case Kind::integer:
        return "0";
    case Kind::day:
        return "yyyy-mm-dd";
    case Kind::real:
        return type.decimals > 0 ? "0." + std::string(static_cast<std::size_t>(type.decimals), '0')
               : type.decimals == ColumnType::shortest ? "General"
                                                       : "0";
    default:
        return "General";
    }
}

std::optional<lxw_datetime> parse_day(std::string_view text) {
    lxw_datetime day{};
    const auto part = [&](std::size_t from, std::size_t count, int& into) {
        return text.size() == 10 &&
               std::from_chars(text.data() + from, text.data() + from + count, into).ptr ==
                   text.data() + from + count;
    };
    constexpr int first_year = 1900; // of Excel's days
    const bool is_day = part(0, 4, day.year) && part(5, 2, day.month) && part(8, 2, day.day);
    return is_day && day.year > first_year ? std::optional{day} : std::nullopt;
}

/// Returns text without bytes that are no UTF-8, cut to what a cell holds.
std::string cell_text(const std::string& text) {
    std::string plain;
    for (std::size_t i = 0; i < text.size() && plain.size() + 4 <= max_text_bytes;) {
        const auto lead = static_cast<unsigned char>(text[i]);
        const std::size_t length = lead < 0x80   ? 1
                                   : lead < 0xc2 ? 0
                                   : lead < 0xe0 ? 2
                                   : lead < 0xf0 ? 3
                                   : lead < 0xf5 ? 4
                                                 : 0;
        const bool is_whole =
            length > 0 && i + length <= text.size() &&
            std::all_of(text.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                        text.begin() + static_cast<std::ptrdiff_t>(i + length),
                        [](char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; });
        const bool is_control = length == 1 && lead < 0x20 && lead != '\t' && lead != '\n';
        plain += is_whole && !is_control ? text.substr(i, length) : "\xEF\xBF\xBD";
        i += is_whole ? length : 1;
    }
    return plain;
}

/// Returns black or white, whichever is easier to read on a colour (ITU-R BT.601 luma).
std::uint32_t ink_on(std::uint32_t rgb) {
    const double luma = 0.299 * (rgb >> 16) + 0.587 * ((rgb >> 8) & 0xff) + 0.114 * (rgb & 0xff);
    return luma > 128 ? 0x000000 : 0xffffff;
}

/// Counts the rows of a sheet in a workbook, which is open at that sheet; `std::nullopt` if it does
/// not end as a sheet does.
std::optional<std::size_t> row_count(archive* workbook) {
    constexpr std::string_view row_end = "</row>";
    constexpr std::string_view sheet_end = "</worksheet>";
    std::string text;
    std::size_t count = 0;
    const void* block = nullptr;
    std::size_t size = 0;
    la_int64_t offset = 0;
    int status = ARCHIVE_OK;
    while ((status = archive_read_data_block(workbook, &block, &size, &offset)) == ARCHIVE_OK) {
        text.append(static_cast<const char*>(block), size);
        std::size_t from = 0;
        for (auto at = text.find(row_end); at != std::string::npos; at = text.find(row_end, from)) {
            ++count;
            from = at + row_end.size();
        }
        text.erase(0, std::max(from, text.size() - std::min(text.size(), sheet_end.size())));
    }
    return status == ARCHIVE_EOF && text.ends_with(sheet_end) ? std::optional{count} : std::nullopt;
}

/// Tests whether a workbook has all rows of its sheets: libxlsxwriter does not report that a disk
/// was full when it wrote its temporary files.
bool is_whole(const std::string& file, std::span<const std::size_t> rows) {
    const std::unique_ptr<archive, int (*)(archive*)> workbook{archive_read_new(),
                                                               &archive_read_free};
    archive_read_support_format_zip(workbook.get());
    constexpr std::size_t block_bytes = 1 << 16;
    if (archive_read_open_filename(workbook.get(), file.c_str(), block_bytes) != ARCHIVE_OK) {
        return false;
    }
    std::size_t whole = 0;
    archive_entry* entry = nullptr;
    while (archive_read_next_header(workbook.get(), &entry) == ARCHIVE_OK) {
        const std::string name = archive_entry_pathname(entry);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (name == fmt::format("xl/worksheets/sheet{}.xml", i + 1) &&
                row_count(workbook.get()) == rows[i]) {
                ++whole;
            }
        }
    }
    return whole == rows.size();
}

} // namespace

struct XlsxWorkbook::State {
    std::filesystem::path file;
    AtomicFileSet files;
    std::string target;
    std::string folder;
    lxw_workbook* book = nullptr;
    lxw_worksheet* sheet = nullptr;
    lxw_format* heading = nullptr;
    std::vector<XlsxColumn> columns{};
    std::vector<lxw_format*> formats{};
    std::size_t rows = 0;
    std::vector<std::size_t> rows_of_sheets{}; ///< with the header
    std::map<std::string, lxw_format*> formats_by_text{};
    std::map<std::uint32_t, lxw_format*> fills{};

    explicit State(const std::filesystem::path& named)
        : file{named}, files{named}, target{files.main_file().string()},
          folder{files.folder().string()} {}

    void expect(lxw_error error) const {
        if (error != LXW_NO_ERROR) {
            throw InputError{
                fmt::format("{}: cannot be written: {}", file.string(), lxw_strerror(error))};
        }
    }

    lxw_format* format_for(const ColumnType& type) {
        const auto text = format_of(type);
        auto& format = formats_by_text[text];
        if (format == nullptr) {
            format = workbook_add_format(book);
            format_set_num_format(format, text.c_str());
        }
        return format;
    }

    lxw_format* fill_of(std::uint32_t rgb) {
        auto& format = fills[rgb];
        if (format == nullptr) {
            format = workbook_add_format(book);
            format_set_bg_color(format, rgb);
            if (ink_on(rgb) != 0) { // black is the default
                format_set_font_color(format, ink_on(rgb));
            }
        }
        return format;
    }

    void finish_sheet() {
        if (sheet != nullptr) {
            rows_of_sheets.push_back(rows + 1);
            expect(worksheet_autofilter(sheet,
                                        0,
                                        0,
                                        static_cast<lxw_row_t>(rows),
                                        static_cast<lxw_col_t>(columns.size() - 1)));
        }
    }

    void write(std::size_t column, const Cell& cell, lxw_format* format) {
        const auto row = static_cast<lxw_row_t>(rows);
        const auto col = static_cast<lxw_col_t>(column);
        const auto& value = cell.value();
        if (const auto* const count = std::get_if<std::int64_t>(&value)) {
            constexpr std::int64_t exact = 999'999'999'999'999; // digits of a number of Excel
            if (*count > exact || *count < -exact) {
                expect(worksheet_write_string(
                    sheet, row, col, fmt::format("{}", *count).c_str(), nullptr));
            } else {
                expect(
                    worksheet_write_number(sheet, row, col, static_cast<double>(*count), format));
            }
        } else if (const auto* const real = std::get_if<double>(&value)) {
            expect(worksheet_write_number(sheet, row, col, *real, format));
        } else if (const auto* const truth = std::get_if<bool>(&value)) {
            expect(worksheet_write_boolean(sheet, row, col, *truth ? 1 : 0, format));
        } else if (const auto* const text = std::get_if<std::string>(&value)) {
            auto day = columns[column].type.kind == Kind::day ? parse_day(*text) : std::nullopt;
            expect(day ? worksheet_write_datetime(sheet, row, col, &*day, format)
                       : worksheet_write_string(sheet, row, col, cell_text(*text).c_str(), format));
        }
    }
};

XlsxWorkbook::XlsxWorkbook(const std::filesystem::path& file, const Properties& properties)
    : state_{std::make_unique<State>(file)} {
    lxw_workbook_options options{}; // later versions of the library have more members
    options.constant_memory = LXW_TRUE;
    options.tmpdir = state_->folder.data();
    state_->book = workbook_new_opt(state_->target.c_str(), &options);
    if (state_->book == nullptr) {
        throw InputError{fmt::format("{}: cannot be written: no memory", file.string())};
    }
    auto title = properties.title, comment = properties.comment;
    lxw_doc_properties stated{};
    stated.title = title.data();
    stated.comments = comment.data();
    stated.created = static_cast<time_t>(std::max(properties.created_s, oldest_s));
    state_->expect(workbook_set_properties(state_->book, &stated));
    state_->heading = workbook_add_format(state_->book);
    format_set_bold(state_->heading);
    format_set_bottom(state_->heading, LXW_BORDER_THIN);
}

XlsxWorkbook::~XlsxWorkbook() {
    if (state_->book != nullptr) {
        lxw_workbook_free(state_->book);
    }
}

void XlsxWorkbook::begin_sheet(const std::string& name, std::vector<XlsxColumn> columns) {
    auto& state = *state_;
    state.finish_sheet();
    state.sheet = workbook_add_worksheet(state.book, name.c_str());
    if (state.sheet == nullptr) {
        throw InputError{fmt::format("{}: cannot be written: no sheet", state.file.string())};
    }
    state.columns = std::move(columns);
    state.rows = 0;
    state.formats.clear();
    worksheet_freeze_panes(state.sheet, 1, 0);
    worksheet_set_landscape(state.sheet); // printed: all columns on a page, as many pages as needed
    worksheet_fit_to_pages(state.sheet, 1, 0);
    state.expect(worksheet_repeat_rows(state.sheet, 0, 0));
    for (std::size_t i = 0; i < state.columns.size(); ++i) {
        const auto& [column, type] = state.columns[i];
        const auto col = static_cast<lxw_col_t>(i);
        const bool is_text = type.kind == Kind::text || type.kind == Kind::raw;
        const double width = std::clamp(
            static_cast<double>(column.size()) + 3, is_text ? 2 * min_width : min_width, max_width);
        state.formats.push_back(state.format_for(type));
        state.expect(worksheet_set_column(state.sheet, col, col, width, nullptr));
        state.expect(worksheet_write_string(
            state.sheet, 0, col, std::string{column}.c_str(), state.heading));
    }
}

void XlsxWorkbook::add_row(const std::vector<Cell>& cells, const std::optional<Fill>& fill) {
    auto& state = *state_;
    if (state.rows == max_rows) {
        throw InputError{fmt::format("{}: a sheet of Excel holds {} rows, and there are more; "
                                     "select fewer segments, or write .csv",
                                     state.file.string(),
                                     max_rows)};
    }
    ++state.rows;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const bool is_filled = fill && fill->column == i;
        state.write(i, cells[i], is_filled ? state.fill_of(fill->rgb) : state.formats[i]);
    }
}

void XlsxWorkbook::commit() {
    state_->finish_sheet();
    state_->expect(workbook_close(std::exchange(state_->book, nullptr)));
    if (!is_whole(state_->target, state_->rows_of_sheets)) {
        throw InputError{
            fmt::format("{}: cannot be written; the disk may be full", state_->file.string())};
    }
    state_->files.commit();
}

} // namespace macadam
