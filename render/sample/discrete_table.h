// DiscreteTable: indices drawn in proportion to their weights, by inverting the cumulative sum.
#pragma once

#include <span>
#include <vector>

namespace inlay {

struct DiscreteTable {
    std::vector<double> cumulative;  // of weights shares; the last entry is 1. Empty: no weights
    double total = 0;                // sum of the weights
    std::vector<int> first;  // k: the index that k / size falls on, where a search for more begins
};

struct DiscreteSample {
    int index = 0;
    double probability = 0;  // of `index`
    double rest = 0;  // where u fell within the index's own interval, [0, 1): a number to use again
};

/// Weights must be finite and >= 0. If all are zero, every index is equally likely.
DiscreteTable make_discrete_table(std::span<const double> weights);

/// `u` in [0, 1). Keeps the order of u, so that stratified numbers stay stratified.
DiscreteSample sample_discrete(const DiscreteTable& table, double u);

double probability_of(const DiscreteTable& table, int index);

}  // namespace inlay
