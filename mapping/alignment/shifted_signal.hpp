#pragma once

#include "mapping/alignment/alignment.hpp"
#include "mapping/alignment/lag_search.hpp"
#include "mapping/alignment/signal.hpp"

#include <cstdint>
#include <span>

namespace macadam {

/// Returns the block (LagLine) that holds the metre beginning at a station.
std::int32_t block_of(std::int32_t metre);

/// Pads a signal with 2 * reach_m of zeros on both sides, and `slack_m` more at the end, so that
/// every lag reads inside the buffer.
Signal padded(const Signal& signal);

inline constexpr std::int32_t pad_m = 2 * reach_m;
inline constexpr std::size_t slack_m = 64;

/// Shifts a padded signal by its lags, over every position that a lag can reach: from reach_m
/// before its first metre to reach_m past its last. Linear between metres.
///
/// \param lag_cm  lags of the blocks from `first_block` on, as in LagLine. At least one, none
///                beyond reach_m.
Signal shifted_signal(const Signal& signal,
                      std::int32_t first_block,
                      std::span<const std::int32_t> lag_cm);

} // namespace macadam
