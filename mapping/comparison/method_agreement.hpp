#pragma once

#include "mapping/network/segment.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// IRI of one segment by two sources, mm/m.
struct AgreementPair {
    SegmentKey segment;
    double a;
    double b;
};

/// Estimate with its 95 % confidence interval; the bounds are NaN if there are too few pairs.
struct Estimate {
    double value;
    double low;
    double high;
};

/// Bias and limits of agreement of differences. NaN if there are too few of them.
struct LimitsOfAgreement {
    Estimate bias;      ///< mean difference
    double sd;          ///< standard deviation of the differences
    Estimate lower;     ///< bias - 1.96 sd
    Estimate upper;     ///< bias + 1.96 sd
    double independent; ///< number of independent differences with a mean as uncertain as theirs
};

/// Agreement of two sources over the segments that both know.
struct MethodAgreement {
    std::size_t pairs = 0;
    double mean_a = 0; ///< mm/m
    double mean_b = 0;
    LimitsOfAgreement difference; ///< of a - b, mm/m
    LimitsOfAgreement relative;   ///< of 100 (a - b) / ((a + b) / 2), percent
};

/// Computes bias and limits of agreement. About 95 % of differences lie between the limits if they
/// are normally distributed.
///
/// Neighbouring segments have similar differences, so n of them tell less than n independent ones.
/// The variance of the mean is s^2/m with m = n / (1 + 2 sum_k (n_k / n) r_k), where r_k is the
/// correlation of differences k segments apart along a road and n_k the number of such pairs,
/// summed over k = 1, 2, ... until r_k <= 0 (at most 50). That of s is s^2 / (2 (v - 1)), with v
/// from the squares of r_k. The intervals are those of Bland and Altman with these numbers: bias +-
/// t s / sqrt(m), limits +- t s sqrt(1/m + 1.96^2 / (2 (v - 1))), t with m - 1 degrees of freedom.
/// An error that all roads share is in the bias, and not in its interval.
///
/// \param pairs  in any order; each segment once.
///
/// Sources: J. M. Bland, D. G. Altman, "Statistical methods for assessing agreement between two
/// methods of clinical measurement", Lancet 327 (1986), pp. 307-310; the same, "Measuring agreement
/// in method comparison studies", Statistical Methods in Medical Research 8 (1999), pp. 135-160;
/// G. V. Bayley, J. M. Hammersley, "The 'effective' number of independent observations in an
/// autocorrelated time series", Supplement to the Journal of the Royal Statistical Society 8
/// (1946), pp. 184-197.
MethodAgreement agreement_of(std::span<const AgreementPair> pairs);

/// Name of a group of pairs, and its place among the groups.
struct GroupName {
    int rank;
    std::string name; ///< "" = in no group
};

struct AgreementGroup {
    std::string name;
    MethodAgreement agreement;
};

/// Computes the agreement within each group, in the order of (rank, name).
///
/// \param names  group of each pair, as many as pairs.
std::vector<AgreementGroup> agreement_by_group(std::span<const AgreementPair> pairs,
                                               std::span<const GroupName> names);

} // namespace macadam
