#pragma once

#include "app/capture/result_capture.hpp"
#include "app/cli/text_table.hpp"
#include "storage/text/columns.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace macadam {

/// Writes rows one after the other as a table, CSV, JSON or GeoJSON; only one is held in memory.
/// While this thread captures results (app/capture), the rows go there instead.
template <typename Row>
class RowWriter {
public:
    using Put = std::function<void(std::string_view)>;
    using Feature = std::function<std::string(const Row&)>; ///< a Feature of GeoJSON

    /// \param format   table, csv, json or geojson
    /// \param columns  must outlive the writer
    RowWriter(std::string_view format, const Columns<Row>& columns, Put put, Feature feature = {})
        : format_{format}, columns_{&columns}, put_{std::move(put)}, feature_{std::move(feature)} {}

    /// Text between two features of GeoJSON.
    std::string_view feature_separator = ",";

    void add(const Row& row) {
        begin();
        if (capture_ != nullptr) {
            capture(row);
            return;
        }
        const auto separator = format_ == "geojson" ? feature_separator
                               : format_ == "json"  ? ","
                                                    : "";
        put_(count_++ == 0 ? "" : separator);
        put_(format_ == "csv"       ? csv_line(*columns_, row)
             : format_ == "json"    ? json_object(*columns_, row).text()
             : format_ == "geojson" ? feature_(row)
                                    : table_row(*columns_, row));
    }

    /// Writes what precedes the rows; add() does so, too.
    void begin() {
        if (std::exchange(has_begun_, true)) {
            return;
        }
        if (capture_ != nullptr) {
            capture_->begin_table(*columns_);
        } else {
            put_(format_ == "csv"       ? csv_header(*columns_)
                 : format_ == "json"    ? "["
                 : format_ == "geojson" ? R"({"type":"FeatureCollection","features":[)"
                                        : table_header(*columns_));
        }
    }

    void finish() {
        if (format_ != "table") {
            begin();
        }
        if (capture_ != nullptr) {
            return;
        }
        put_(format_ == "json" ? "]\n" : format_ == "geojson" ? "]}\n" : "");
    }

    std::size_t count() const { return count_; }

private:
    void capture(const Row& row) {
        capture_->add_row(*columns_, row);
        if (feature_ && capture_->wants_features()) {
            capture_->add_feature(feature_(row));
        }
        ++count_;
    }

    std::string format_;
    const Columns<Row>* columns_;
    Put put_;
    Feature feature_;
    ResultCapture* capture_ = ResultCapture::current();
    bool has_begun_ = false;
    std::size_t count_ = 0;
};

/// Formats rows as a table, CSV, JSON or GeoJSON.
template <typename Row, typename Rows>
std::string rows_text(const Columns<Row>& columns,
                      const Rows& rows,
                      std::string_view format,
                      typename RowWriter<Row>::Feature feature = {}) {
    std::string text;
    RowWriter<Row> writer{
        format, columns, [&](std::string_view more) { text += more; }, std::move(feature)};
    writer.begin();
    for (const auto& row : rows) {
        writer.add(row);
    }
    writer.finish();
    return text;
}

} // namespace macadam
