#pragma once

#include "mapping/geometry/local_frame.hpp"
#include "mapping/surveys/survey_row.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace macadam {

/// Interval of a row on its line, metres along that line.
struct SurveyPiece {
    std::size_t row;
    double from_m;
    double to_m;
};

/// Rows that follow each other on a road.
struct SurveyLine {
    std::vector<SurveyPiece> pieces; ///< in driving order
};

/// A straight leg of a line, in driving direction.
struct SurveyLeg {
    PointEn begin;
    PointEn end; ///< differs from begin
    std::size_t line;
    double begin_m; ///< along its line
    PointEn course; ///< of the line around here; a unit vector
};

struct SurveyLines {
    std::vector<SurveyLine> lines;
    std::vector<SurveyLeg> legs;
};

/// Builds lines from the rows; the first and last leg of each extend to the ends of its intervals.
SurveyLines survey_lines(std::span<const SurveyRow> survey, const LocalFrame& frame);

/// The point of a leg nearest to a position.
struct LegPosition {
    std::size_t line;
    double station_m;
    double distance_m;
};
LegPosition nearest_on(const SurveyLeg& leg, const PointEn& point);

/// A grid index of legs.
class SurveyLegIndex {
public:
    /// \param reach_m  maximum distance at which a leg is found.
    SurveyLegIndex(std::span<const SurveyLeg> legs, double reach_m);

    /// Returns the indices of all legs within reach of the point, and possibly some more.
    std::span<const std::size_t> near(const PointEn& point) const;

private:
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> squares_;
};

} // namespace macadam
