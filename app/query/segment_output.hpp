#pragma once

#include "mapping/style/iri_class.hpp"
#include "storage/store/road_store.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Segments as `query` prints them, one after the other: however many there are, one is held.
class SegmentPrinter {
public:
    /// \param format  table, json, csv or geojson. \param classes  outlives the printer.
    SegmentPrinter(std::string_view format, const ClassTable& classes);

    void add(const SegmentRecord& record);
    void finish();

    std::size_t count() const { return count_; }

private:
    std::string format_;
    const ClassTable* classes_;
    std::size_t count_ = 0;
};

/// The passes over one segment. \param format  table, json or csv.
std::string passes_text(const std::vector<HistoricPass>& passes, std::string_view format);

/// Prints results: a table is for people, the other formats are for programs.
void print_in(std::string_view format, std::string_view text);

} // namespace macadam
