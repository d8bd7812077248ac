// The blend under floating-point traps: no input may make an invalid operation, a division by zero
// or an overflow, and every result is finite, bounded and continuous.
#include "composite/blend/differential.h"
#include "recordings/base/parallel.h"
#include "tests/support/floating_point_traps.h"
#include "tests/support/layers_of_one_value.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

namespace inlay {
namespace {

/// Runs `body` under traps and ends the process: 0 when no expectation failed. For EXPECT_EXIT in
/// the threadsafe style, which starts the program anew: TBB hands the floating-point environment of
/// its first use to all of its threads and keeps it, so that a body which shares the process with
/// other tests would leave them trapped, or find its own traps disarmed.
template <class Body>
[[noreturn]] void exit_after(Body body) {
    const test::FloatingPointTraps traps;
    body();
    std::_Exit(testing::Test::HasFailure() ? 1 : 0);
}

class BlendHardCases : public testing::Test {
protected:
    void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

struct HardCase {
    float e_r, e_rv, m;
};

std::vector<HardCase> hard_cases() {
    const float huge = std::numeric_limits<float>::max();
    const float denormal = std::numeric_limits<float>::denorm_min();
    std::vector<HardCase> cases;
    for (const float m : {0.0f, 0.25f, 1.0f})
        for (const float e_r : {0.0f, denormal, 1e-38f, 1e-6f, 1.0f, huge})
            for (const float e_rv : {0.0f, denormal, 1e-38f, 1e-30f, 1e-3f, 1e-2f, 1.0f, huge})
                cases.push_back({e_r, e_rv, m});
    return cases;
}

Layers layers_of(const HardCase& c, int width) {
    Layers layers = test::untouched_layers(width, 1, c.e_r);
    layers.m = Image<float>(width, 1, c.m);
    layers.direct.e_rv_real = Image<Rgb>(width, 1, Rgb(c.e_rv));
    layers.direct.e_rv_virtual = Image<Rgb>(width, 1, Rgb(c.e_rv));
    layers.k_v = Image<Rgb>(width, 1, Rgb(0.3f));
    return layers;
}

void expect_all_bounded() {
    for (const BlendForm form : {BlendForm::ratio, BlendForm::additive})
        for (const std::uint8_t grey : {0, 1, 128, 255})
            for (const HardCase& c : hard_cases()) {
                const Photo photo = test::grey_photo(1, 1, grey);
                const Composite result = composite(photo, layers_of(c, 1), {.form = form});
                const double value = double(result.linear(0, 0).r);
                ASSERT_TRUE(std::isfinite(value)) << c.e_r << " " << c.e_rv << " " << c.m;
                ASSERT_GE(value, 0);
                // the virtual part is k_V E_RV; the real one at most 4 L_cam or L_cam + E_RV / pi
                const double e_rv = double(c.e_rv);
                ASSERT_LE(value, 0.3 * e_rv + 4 + e_rv) << c.e_r << " " << c.e_rv << " " << c.m;
            }
}

void expect_first_pixel_as_recorded() {
    const Photo photo = test::grey_photo(3, 1, 128);
    for (const HardCase& c : hard_cases()) {
        Layers layers = layers_of(c, 3);
        layers.m(0, 0) = 1;
        layers.direct.e_r(0, 0) = layers.direct.e_rv_real(0, 0) = Rgb(1e-3f);
        EXPECT_EQ(composite(photo, layers).display(0, 0), photo.encoded(0, 0));
    }
}

void expect_not_a_number_replaced() {
    const Photo photo = test::grey_photo(1, 1, 128);
    Layers layers = test::untouched_layers(1, 1, 1.0f);
    layers.direct.e_rv_real(0, 0) = Rgb(std::numeric_limits<float>::quiet_NaN());
    layers.m(0, 0) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(composite(photo, layers).replaced_pixels, 1u);
}

TEST_F(BlendHardCases, TheTrapsAreArmed) {
    const auto divide_by_zero = [] {
        parallel_for(1, [](int) {
            volatile double zero = 0;
            volatile double quotient = 1 / zero;
            static_cast<void>(quotient);
        });
    };
    EXPECT_EXIT(exit_after(divide_by_zero), testing::KilledBySignal(SIGFPE), "");
}

TEST_F(BlendHardCases, AreFiniteAndBoundedUnderTraps) {
    EXPECT_EXIT(exit_after(expect_all_bounded), testing::ExitedWithCode(0), "");
}

TEST_F(BlendHardCases, ExtremeNeighboursDoNotSpoilAPixel) {
    EXPECT_EXIT(exit_after(expect_first_pixel_as_recorded), testing::ExitedWithCode(0), "");
}

TEST_F(BlendHardCases, NotANumberPassesUnderTraps) {
    EXPECT_EXIT(exit_after(expect_not_a_number_replaced), testing::ExitedWithCode(0), "");
}

TEST_F(BlendHardCases, TheRatioIsContinuousWhereTheLightGoesOut) {
    // E_R from 1 to 0 in steps of 10 %: with epsilon = 1e-3 and E_RV = E_R + 1e-5 the ratio's
    // largest slope is 1e-5 / epsilon^2 = 10 per unit, that is 1e-3 per step below epsilon
    double before = bounded_ratio(1, 1 + 1e-5, 1e-3, 4);
    for (double e_r = 1; e_r > 1e-12; e_r *= 0.9) {
        const double ratio = bounded_ratio(e_r, e_r + 1e-5, 1e-3, 4);
        EXPECT_LT(std::abs(ratio - before), 1e-3) << e_r;
        before = ratio;
    }
    EXPECT_NEAR(before, bounded_ratio(0, 1e-5, 1e-3, 4), 1e-9);  // and it meets its limit
}

TEST_F(BlendHardCases, NoiseOfTheIrradianceIsNotAmplifiedBeyondTheBound) {
    // A relative disturbance d of E_RV changes the ratio by at most d times the ratio
    for (double e_r = 1e-9; e_r < 10; e_r *= 10)
        for (double e_rv = 1e-9; e_rv < 10; e_rv *= 10) {
            const double ratio = bounded_ratio(e_r, e_rv, 1e-3, 4);
            const double disturbed = bounded_ratio(e_r, e_rv * 1.01, 1e-3, 4);
            EXPECT_LE(std::abs(disturbed - ratio), 0.0101 * std::max(ratio, 1.0));
        }
}

}  // namespace
}  // namespace inlay
