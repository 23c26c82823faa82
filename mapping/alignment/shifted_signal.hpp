#pragma once

#include "mapping/alignment/alignment.hpp"
#include "mapping/alignment/lag_search.hpp"
#include "mapping/alignment/signal.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace macadam {

/// The block (LagLine) that holds the metre which begins at a station.
std::int32_t block_of(std::int32_t metre);

/// A signal between silences of 2 * reach_m, and a little more behind: whatever the lag, what is
/// asked for is there.
Signal padded(const Signal& signal);

inline constexpr std::int32_t pad_m = 2 * reach_m;
inline constexpr std::size_t slack_m = 64;

/// A padded signal where its lags put it, over all places that a lag can put it to: from reach_m
/// before its first metre to reach_m behind its last. Straight between metres.
///
/// \param lag_cm  of the blocks from `first_block` on, as LagLine. At least one, none beyond
///                reach_m.
Signal shifted_signal(const Signal& signal,
                      std::int32_t first_block,
                      std::span<const std::int32_t> lag_cm);

} // namespace macadam
