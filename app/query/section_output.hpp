#pragma once

#include "app/query/section_query.hpp"
#include "mapping/style/iri_class.hpp"

#include <functional>
#include <string>
#include <string_view>

namespace macadam {

/// Writes sections as text, one after the other.
class SectionWriter {
public:
    using Put = std::function<void(std::string_view)>;

    /// \param format   table, json, csv or geojson
    /// \param classes  must outlive the writer
    SectionWriter(std::string_view format, const ClassTable& classes, Put put);

    void add(const NamedSection& section);
    void finish();

    std::size_t count() const { return count_; }

private:
    std::string format_;
    const ClassTable* classes_;
    Put put_;
    std::size_t count_ = 0;
};

/// Describes a total: "3.42 km, 2.97 km of them measured".
std::string spoken(const SectionTotal& total);

} // namespace macadam
