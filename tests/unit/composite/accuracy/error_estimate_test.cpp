// The estimate without truth halves any number of samples that has a half.
#include "composite/accuracy/error_estimate.h"

#include "composite/accuracy/judged_frames.h"
#include "recordings/base/check.h"
#include "tests/support/tabletop_work.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace inlay {
namespace {

SamplingSettings split(int primary, int secondary) {
    SamplingSettings sampling;
    sampling.primary = primary;
    sampling.secondary = secondary;
    return sampling;
}

std::pair<int, int> share(int primary, int secondary, int samples) {
    const SamplingSettings part = share_of_samples(split(primary, secondary), samples);
    return {part.primary, part.secondary};
}

TEST(ShareOfSamples, HasTheNumberThatIsAskedFor) {
    EXPECT_EQ(share(4, 4, 8), std::pair(4, 2));
    EXPECT_EQ(share(4, 4, 4), std::pair(4, 1));
    EXPECT_EQ(share(4, 3, 6), std::pair(3, 2));
    EXPECT_EQ(share(4, 3, 3), std::pair(3, 1));
    EXPECT_EQ(share(1, 2, 1), std::pair(1, 1));
    EXPECT_EQ(share(16, 1, 4), std::pair(4, 1));
    EXPECT_EQ(share(2, 7, 7), std::pair(1, 7));
    EXPECT_THROW(share(4, 4, 0), Error);
}

std::optional<EstimateQuality> quality_of(int primary, int secondary) {
    const Work work = test::tabletop_work();
    Settings settings;
    settings.trace.primary = primary;
    settings.trace.secondary = secondary;
    return check_estimate(work, judge_frames(work, {0}, {settings}, 64), settings);
}

TEST(CheckEstimate, TakesAnyNumberOfSamplesFromTwoOn) {
    for (const auto& [primary, secondary] : {std::pair{4, 3}, {1, 2}, {3, 1}}) {
        const auto quality = quality_of(primary, secondary);
        ASSERT_TRUE(quality.has_value()) << primary << " x " << secondary;
        ASSERT_EQ(quality->frames.size(), 1u);
        EXPECT_GT(quality->frames[0].true_rmse, 0);
        EXPECT_TRUE(std::isfinite(quality->rank_correlation + quality->calibration));
    }
}

TEST(CheckEstimate, HasNothingToSayOfOneSample) { EXPECT_FALSE(quality_of(1, 1).has_value()); }

}  // namespace
}  // namespace inlay
