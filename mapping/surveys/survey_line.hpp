#pragma once

#include "mapping/geometry/local_frame.hpp"
#include "mapping/surveys/survey_row.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace macadam {

/// The piece of a row on its line, metres along that line.
struct SurveyPiece {
    std::size_t row;
    double from_m;
    double to_m;
};

/// Rows that follow each other on a road.
struct SurveyLine {
    std::vector<SurveyPiece> pieces; ///< in driving order
};

/// A straight part of a line, directed as it was driven.
struct SurveyLeg {
    PointEn begin;
    PointEn end; ///< another place than begin
    std::size_t line;
    double begin_m; ///< along its line
    PointEn course; ///< of the line about here; a unit vector
};

struct SurveyLines {
    std::vector<SurveyLine> lines;
    std::vector<SurveyLeg> legs;
};

/// Lines from the rows; the first and last leg of each reach to the ends of its pieces.
SurveyLines survey_lines(std::span<const SurveyRow> survey, const LocalFrame& frame);

/// The place of a leg that is nearest to a point.
struct PlaceOnLeg {
    std::size_t line;
    double station_m;
    double distance_m;
};
PlaceOnLeg nearest_on(const SurveyLeg& leg, const PointEn& point);

/// Legs by squares of the plane.
class SurveyLegIndex {
public:
    /// \param reach_m  how far from a leg it is still found.
    SurveyLegIndex(std::span<const SurveyLeg> legs, double reach_m);

    /// Those within reach of the point, and some more; numbers of legs.
    std::span<const std::size_t> near(const PointEn& point) const;

private:
    std::unordered_map<std::uint64_t, std::vector<std::size_t>> squares_;
};

} // namespace macadam
