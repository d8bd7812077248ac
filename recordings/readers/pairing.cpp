#include "recordings/readers/pairing.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace inlay {
namespace {

struct Candidate {
    std::int64_t difference = 0;
    TimePair pair;
};

std::vector<int> order_of(std::span<const std::int64_t> stamps) {
    std::vector<int> order(stamps.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(
        order, [&](int i, int j) { return stamps[std::size_t(i)] < stamps[std::size_t(j)]; });
    return order;
}

std::vector<Candidate> candidates_within(std::span<const std::int64_t> a,
                                         std::span<const std::int64_t> b, std::int64_t tolerance) {
    const std::vector<int> order_a = order_of(a), order_b = order_of(b);
    std::vector<Candidate> candidates;
    std::size_t first = 0;
    for (const int i : order_a) {
        const std::int64_t stamp = a[std::size_t(i)];
        while (first < order_b.size() && b[std::size_t(order_b[first])] < stamp - tolerance)
            ++first;
        for (std::size_t k = first; k < order_b.size(); ++k) {
            const std::int64_t difference = b[std::size_t(order_b[k])] - stamp;
            if (difference > tolerance) break;
            candidates.push_back({std::abs(difference), {i, order_b[k]}});
        }
    }
    return candidates;
}

}  // namespace

std::vector<TimePair> pair_by_time(std::span<const std::int64_t> a, std::span<const std::int64_t> b,
                                   std::int64_t tolerance) {
    std::vector<Candidate> candidates = candidates_within(a, b, tolerance);
    std::ranges::sort(candidates, {}, [](const Candidate& c) {
        return std::tuple(c.difference, c.pair.a, c.pair.b);
    });
    std::vector<bool> used_a(a.size()), used_b(b.size());
    std::vector<TimePair> pairs;
    for (const Candidate& c : candidates) {
        if (used_a[std::size_t(c.pair.a)] || used_b[std::size_t(c.pair.b)]) continue;
        used_a[std::size_t(c.pair.a)] = used_b[std::size_t(c.pair.b)] = true;
        pairs.push_back(c.pair);
    }
    std::ranges::sort(pairs, {}, &TimePair::a);
    return pairs;
}

}  // namespace inlay
