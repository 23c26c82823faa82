#include "storage/store/rows/pass_writer.hpp"

#include "storage/store/rows/pass_row.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

namespace macadam {
namespace {

std::string_view bytes_of(const std::vector<RoughnessCode>& codes) {
    return {reinterpret_cast<const char*>(codes.data()), codes.size()};
}

} // namespace

std::vector<NumberedEvent> numbered_events(std::span<const PassEvent> events) {
    std::vector<NumberedEvent> numbered;
    for (const auto& event : events) {
        numbered.push_back({0, event});
    }
    const auto pass_of = [](const PassEvent& event) {
        return std::tuple{event.segment, event.occurrence};
    };
    std::ranges::sort(numbered, {}, [&](const NumberedEvent& one) {
        const auto& event = one.event;
        return std::tuple{pass_of(event), event.at_mm, event.kind, event.track, event.size_um};
    });
    for (std::size_t i = 1; i < numbered.size(); ++i) {
        const auto& before = numbered[i - 1];
        numbered[i].number =
            pass_of(numbered[i].event) == pass_of(before.event) ? before.number + 1 : 0;
    }
    return numbered;
}

PassWriter::PassWriter(Database& database, std::int64_t segments_per_chunk, Destination destination)
    : marks_{destination == Destination::kept}, segments_{database, segments_per_chunk},
      add_pass_{database, marks_ ? "INSERT INTO pass" : "INSERT INTO staged_pass", 15},
      add_trace_{database.prepare(marks_
                                      ? "INSERT INTO trace VALUES (?, ?, ?, ?, ?, ?, ?)"
                                      : "INSERT INTO staged_trace VALUES (?, ?, ?, ?, ?, ?, ?)")},
      add_event_{database, marks_ ? "INSERT INTO event" : "INSERT INTO staged_event", 11},
      mark_segment_{database, "INSERT OR IGNORE INTO segment_dirty", 1},
      mark_chunk_{database, "INSERT OR IGNORE INTO strip_dirty", 1} {}

void PassWriter::write(std::int64_t trip,
                       std::span<const Pass> passes,
                       std::span<const RoughnessTrace> traces,
                       std::span<const PassEvent> events) {
    write_events(trip, events);
    for (const auto& pass : passes) {
        const auto segment = segments_.row_of(pass.segment);
        write_pass(segment, trip, pass);
        if (marks_ && marked_segments_.insert(segment).second) {
            mark_segment_.add(segment);
        }
    }
    for (const auto& trace : traces) {
        const auto chunk = segments_.row_of(trace.chunk);
        write_trace(chunk, trip, trace);
        // A trace can also shift others where its trip has no pass.
        if (marks_ && marked_chunks_.insert(chunk).second) {
            mark_chunk_.add(chunk);
        }
    }
}

void PassWriter::flush() {
    add_pass_.flush();
    add_event_.flush();
    mark_segment_.flush();
    mark_chunk_.flush();
}

void PassWriter::write_pass(std::int64_t segment, std::int64_t trip, const Pass& pass) {
    add_pass_row(add_pass_, segment, trip, pass, whole(pass.drive));
}

void PassWriter::write_events(std::int64_t trip, std::span<const PassEvent> events) {
    for (const auto& [number, event] : numbered_events(events)) {
        add_event_.add(segments_.row_of(event.segment),
                       trip,
                       std::int64_t{event.occurrence},
                       number,
                       static_cast<std::int64_t>(event.kind),
                       static_cast<std::int64_t>(event.track),
                       event.at_mm,
                       std::int64_t{event.place_sd_mm},
                       std::int64_t{event.size_um},
                       std::int64_t{event.sd_um},
                       std::int64_t{event.length_mm});
    }
}

void PassWriter::write_trace(std::int64_t chunk, std::int64_t trip, const RoughnessTrace& trace) {
    add_trace_.run(chunk,
                   trip,
                   std::int64_t{trace.drive},
                   std::int64_t{trace.first_m},
                   std::int64_t{trace.place_sd_mm},
                   Blob{bytes_of(trace.iri)},
                   trace.left.empty() ? std::nullopt : std::optional{Blob{bytes_of(trace.left)}});
}

} // namespace macadam
