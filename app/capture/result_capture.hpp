#pragma once

#include "storage/text/columns.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Values of one column. One of the three lists is filled, by the kind of the column's type.
struct CapturedColumn {
    std::string name;
    ColumnType type;
    std::vector<double> reals{};          ///< NaN: unknown
    std::vector<std::int64_t> integers{}; ///< of integers and truths; 0: unknown
    std::vector<std::string> texts{};     ///< of text, days and raw values; "": unknown
    std::vector<bool> is_known{};

    void add(const Cell& cell);
};

/// Rows as typed columns of one length.
struct CapturedTable {
    std::vector<CapturedColumn> columns;
    std::vector<std::string> features; ///< GeoJSON, one for each row, if it was asked for
};

/// Message for people.
struct CapturedMessage {
    bool is_warning;
    std::string words;
};

/// Results of a command.
struct CapturedResult {
    std::optional<CapturedTable> table; ///< if the command writes rows
    std::string text;                   ///< results that are no rows
    std::vector<CapturedMessage> messages;
};

/// Takes the results of commands that this thread runs, while the object exists: rows as values
/// instead of text, and messages instead of lines on standard error. For callers within the
/// process; one object a thread.
class ResultCapture {
public:
    /// \param with_features  also keep rows as GeoJSON, where they have a geometry
    explicit ResultCapture(bool with_features = false);
    ResultCapture(const ResultCapture&) = delete;
    ResultCapture& operator=(const ResultCapture&) = delete;
    ~ResultCapture();

    /// Returns the object of this thread; null if there is none.
    static ResultCapture* current();

    /// Begins the table of a command.
    /// \throws std::logic_error  if the command has begun one.
    template <typename Row>
    void begin_table(const Columns<Row>& columns) {
        begin({});
        for (const auto& column : columns) {
            if (is_captured(columns, column)) {
                result_.table->columns.push_back({std::string{column.name}, column.type});
            }
        }
    }

    template <typename Row>
    void add_row(const Columns<Row>& columns, const Row& row) {
        auto captured = result_.table->columns.begin();
        for (const auto& column : columns) {
            if (is_captured(columns, column)) {
                (captured++)->add(column.value(row));
            }
        }
    }

    bool wants_features() const { return with_features_; }
    void add_feature(std::string feature) { result_.table->features.push_back(std::move(feature)); }

    void add_text(std::string_view text) { result_.text += text; }
    void add_message(bool is_warning, std::string_view words) {
        result_.messages.push_back({is_warning, std::string{words}});
    }

    CapturedResult take() { return std::move(result_); }

private:
    void begin(CapturedTable table);

    /// Tests whether a column is taken: those of JSON, and of CSV those that JSON has in no form.
    template <typename Row>
    static bool is_captured(const Columns<Row>& columns, const Column<Row>& column) {
        if (column.type.formats != ColumnType::Formats::csv) {
            return !column.name.empty();
        }
        bool is_in_json = column.type.kind == ColumnType::Kind::raw; // a list, which JSON nests
        for (const auto& other : columns) {
            is_in_json = is_in_json ||
                         (other.name == column.name && is_in(other, ColumnType::Formats::json));
        }
        return !is_in_json;
    }

    CapturedResult result_;
    bool with_features_;
};

} // namespace macadam
