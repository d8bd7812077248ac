// Nearest-in-time pairing of two streams, each item used at most once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace inlay {

struct TimePair {
    int a = 0, b = 0;  // places in the two streams
    bool operator==(const TimePair&) const = default;
};

/// Pairs items whose stamps (ns) differ by at most `tolerance` (ns): the closest pair of all first,
/// then the closest of what is left. The result is ordered by place in `a`; the streams need not
/// be sorted.
std::vector<TimePair> pair_by_time(std::span<const std::int64_t> a, std::span<const std::int64_t> b,
                                   std::int64_t tolerance);

}  // namespace inlay
