#pragma once

#include "mapping/style/iri_class.hpp"
#include "storage/store/road_store.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Prints segments for `query`, one after the other; only one is held in memory.
class SegmentPrinter {
public:
    /// \param format   table, json, csv or geojson
    /// \param classes  must outlive the printer
    SegmentPrinter(std::string_view format, const ClassTable& classes);

    void add(const SegmentRecord& record);
    void finish();

    std::size_t count() const { return count_; }

private:
    std::string format_;
    const ClassTable* classes_;
    std::size_t count_ = 0;
};

/// Formats the passes over one segment.
/// \param format  table, json or csv
std::string passes_text(const std::vector<HistoricPass>& passes, std::string_view format);

/// Prints results: a table for people, the other formats for programs.
void print_in(std::string_view format, std::string_view text);

} // namespace macadam
