// DiscreteTable: shares, order, and the entries that must never come.
#include "render/sample/discrete_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace inlay::test {
namespace {

TEST(DiscreteTable, ProbabilitiesAreTheWeightsShares) {
    const std::vector<double> weights{1, 0, 3, 4};
    const DiscreteTable table = make_discrete_table(weights);
    EXPECT_EQ(table.total, 8);
    for (std::size_t i = 0; i < weights.size(); ++i)
        EXPECT_DOUBLE_EQ(probability_of(table, int(i)), weights[i] / 8);
}

TEST(DiscreteTable, EntriesWithoutWeightNeverCome) {
    const DiscreteTable table = make_discrete_table(std::vector<double>{0, 2, 0, 0, 1, 0});
    for (int i = 0; i < 4096; ++i) {
        const DiscreteSample s = sample_discrete(table, i / 4096.0);
        EXPECT_TRUE(s.index == 1 || s.index == 4) << s.index;
    }
    EXPECT_EQ(sample_discrete(table, std::nextafter(1.0, 0.0)).index, 4);
}

TEST(DiscreteTable, TheRestOfTheNumberIsUniformWithinItsEntry) {
    const DiscreteTable table = make_discrete_table(std::vector<double>{1, 0, 3, 4});
    for (int i = 0; i < 1000; ++i) {
        const double u = i / 1000.0;
        const DiscreteSample s = sample_discrete(table, u);
        double begin = 0;
        for (int j = 0; j < s.index; ++j)
            begin += probability_of(table, j);
        EXPECT_NEAR(begin + s.rest * s.probability, u, 1e-15);
        EXPECT_GE(s.rest, 0);
        EXPECT_LT(s.rest, 1);
    }
}

TEST(DiscreteTable, WithoutAnyWeightAllEntriesAreEqual) {
    const DiscreteTable table = make_discrete_table(std::vector<double>{0, 0, 0, 0});
    EXPECT_EQ(table.total, 0);
    for (int i = 0; i < 4; ++i) {
        EXPECT_DOUBLE_EQ(probability_of(table, i), 0.25);
        EXPECT_EQ(sample_discrete(table, 0.25 * i).index, i);
    }
}

TEST(DiscreteTable, HoldsWeightsOverManyOrdersOfMagnitude) {
    const DiscreteTable table = make_discrete_table(std::vector<double>{1e-30, 5e4, 1e-3});
    EXPECT_NEAR(probability_of(table, 1), 1, 1e-7);
    EXPECT_EQ(sample_discrete(table, 0.5).index, 1);
}

}  // namespace
}  // namespace inlay::test
