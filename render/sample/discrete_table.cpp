#include "render/sample/discrete_table.h"

#include <algorithm>
#include <cmath>

namespace inlay {

DiscreteTable make_discrete_table(std::span<const double> weights) {
    DiscreteTable table;
    table.cumulative.reserve(weights.size());
    for (const double w : weights)
        table.cumulative.push_back(table.total += w);
    const double count = double(weights.size());
    for (std::size_t i = 0; i < table.cumulative.size(); ++i) {
        double& c = table.cumulative[i];
        c = table.total > 0 ? c / table.total : double(i + 1) / count;
    }
    if (!table.cumulative.empty()) table.cumulative.back() = 1;
    int index = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
        while (!(table.cumulative[std::size_t(index)] > double(k) / count))
            ++index;
        table.first.push_back(index);
    }
    return table;
}

DiscreteSample sample_discrete(const DiscreteTable& table, double u) {
    const auto& c = table.cumulative;
    const std::size_t last = c.size() - 1;
    auto at = std::size_t(table.first[std::min(std::size_t(u * double(c.size())), last)]);
    while (at > 0 && c[at - 1] > u)  // the product may be rounded up
        --at;
    while (at < last && !(c[at] > u))
        ++at;
    const int index = int(at);
    const double begin = index > 0 ? c[at - 1] : 0.0;
    const double probability = c[at] - begin;
    const double rest = probability > 0 ? (u - begin) / probability : 0.0;
    return {index, probability, std::clamp(rest, 0.0, std::nextafter(1.0, 0.0))};
}

double probability_of(const DiscreteTable& table, int index) {
    const auto& c = table.cumulative;
    return c[std::size_t(index)] - (index > 0 ? c[std::size_t(index - 1)] : 0.0);
}

}  // namespace inlay
