// Eq. 6.2: closed forms, the bounded ratio, and the photograph kept where nothing changed.
#include "composite/blend/differential.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "recordings/base/random.h"
#include "tests/support/layers_of_one_value.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace inlay {
namespace {

using test::grey_photo;
using test::untouched_layers;

TEST(BoundedRatio, IsExactlyOneForEqualIrradiance) {
    for (const double e : {0.0, 1e-38, 1e-6, 1.0, 3e4})
        for (const double epsilon : {0.0, 1e-3})
            EXPECT_EQ(bounded_ratio(e, e, epsilon, 4), 1.0);
}

TEST(BoundedRatio, FollowsTheEpsilonForm) {
    // E_R = 1e-6, E_RV = 1e-2, epsilon = 1e-3 x 0.5: 0.2 x ratio is 4.19 unbounded
    const double unbounded = bounded_ratio(1e-6, 1e-2, 5e-4, 1e6);
    EXPECT_NEAR(0.2 * unbounded, 4.19, 0.005);  // the value is known to 3 digits
    EXPECT_EQ(bounded_ratio(1e-6, 1e-2, 5e-4, 4), 4.0);
}

TEST(BoundedRatio, IsTheLargestOneInADarkRoom) {
    EXPECT_EQ(bounded_ratio(0, 1e-3, 0, 4), 4.0);
    EXPECT_EQ(bounded_ratio(1e-38, 1e-30, 0, 4), 4.0);
}

TEST(BoundedRatio, GrowsWithTheNewLightAndShrinksWithTheOld) {
    for (double e = 1e-6; e < 10; e *= 3) {
        EXPECT_LE(bounded_ratio(1, e, 1e-3, 4), bounded_ratio(1, 3 * e, 1e-3, 4));
        EXPECT_GE(bounded_ratio(e, 1, 1e-3, 4), bounded_ratio(3 * e, 1, 1e-3, 4));
    }
}

TEST(AdditiveChange, StaysBoundedWhereTheRatioDoesNot) {
    // k = 1: 0.2 + (1e-2 - 1e-6) / pi
    EXPECT_NEAR(additive_change(0.2, 1e-6, 1e-2), 0.2032, 5e-5);  // known to 4 digits
}

TEST(AdditiveChange, IsTheRatioWhereTheReflectanceIsPlausible) {
    // k = pi L / E_R < 1 makes both forms the same
    for (const double e_rv : {0.0, 0.3, 1.0, 1.7})
        EXPECT_NEAR(additive_change(0.2, 1.0, e_rv), 0.2 * e_rv, 1e-15);  // rounding
}

TEST(AdditiveChange, IsNeverNegative) {
    for (const double camera : {0.0, 1e-6, 0.2, 1.0})
        for (const double e_r : {0.0, 1e-38, 1e-6, 0.1, 3.0})
            EXPECT_GE(additive_change(camera, e_r, 0), 0) << camera << " " << e_r;
}

TEST(Composite, KeepsEveryRecordedByteWithoutVirtualObjects) {
    Image<EncodedRgb> recorded(64, 32);
    for (std::size_t i = 0; i < recorded.pixels.size(); ++i) {
        const auto byte = std::uint8_t(hash(std::uint32_t(i)));
        recorded.pixels[i] = {byte, std::uint8_t(i), std::uint8_t(255 - byte)};
    }
    const Photo photo = linearise(recorded);
    for (const BlendForm form : {BlendForm::ratio, BlendForm::additive}) {
        const Composite result = composite(photo, untouched_layers(64, 32, 0.37f), {.form = form});
        EXPECT_EQ(result.display.pixels, recorded.pixels);
        EXPECT_EQ(result.linear.pixels, photo.linear.pixels);
        EXPECT_EQ(result.virtual_pixels, 0u);
        EXPECT_EQ(result.influenced_pixels, 0u);
        EXPECT_EQ(result.replaced_pixels, 0u);
    }
}

TEST(Composite, LeavesHolesOfTheRealGeometryAsRecorded) {
    const Photo photo = grey_photo(2, 1, 100);
    Layers layers = untouched_layers(2, 1, 1.0f);
    layers.direct.e_rv_real(0, 0) = Rgb(0.5f);  // a shadow beside the hole
    layers.direct.e_r(1, 0) = layers.direct.e_rv_real(1, 0) = Rgb(0);
    const Composite result = composite(photo, layers);
    EXPECT_EQ(result.display(1, 0), photo.encoded(1, 0));
    EXPECT_LT(result.display(0, 0).r, 100);
    EXPECT_EQ(result.influenced_pixels, 1u);
}

/// A camera that opens up by half between two frames: the same virtual object has the same radiance
/// and is shown brighter by as much as the room around it.
TEST(Composite, VirtualObjectsFollowTheExposureOfThePhotograph) {
    const Rgb gain{1.5f, 1.4f, 1.6f};
    Layers layers = untouched_layers(3, 1, 1.0f);
    layers.m(1, 0) = 0;  // a virtual object that sends 0.2
    layers.s_rv(1, 0) = Rgb(0.2f);
    layers.direct.e_rv_real(2, 0) = Rgb(0.5f);  // a shadow
    const Rgb room(0.3f);
    const Photo before = linearise(encode(Image<Rgb>(3, 1, room)));
    const Photo after = linearise(encode(Image<Rgb>(3, 1, room * gain)), gain);
    const Composite a = composite(before, layers), b = composite(after, layers);
    EXPECT_EQ(b.display(0, 0), after.encoded(0, 0));  // as recorded, whatever the exposure
    EXPECT_EQ(b.display(1, 0), encode(Rgb(0.2f) * gain));
    EXPECT_EQ(a.linear(1, 0), b.linear(1, 0));
    for (int c = 0; c < 3; ++c)  // bytes of the two photographs differ by their rounding
        EXPECT_NEAR(a.linear(2, 0)[c], b.linear(2, 0)[c], 0.002f);
    const Photo judged = at_reference_exposure(after);
    EXPECT_EQ(judged.encoded(0, 0), before.encoded(0, 0));
    EXPECT_EQ(judged.exposure, Rgb(1));
}

TEST(Composite, ShadowsScaleTheLinearPhotograph) {
    const Photo photo = grey_photo(1, 1, 200);
    Layers layers = untouched_layers(1, 1, 2.0f);
    layers.direct.e_rv_real(0, 0) = {1.0f, 0.5f, 2.0f};
    const Composite result = composite(photo, layers);
    const float camera = photo.linear(0, 0).r;
    // epsilon is 1e-3 of E_R, so a ratio r becomes (r + 1e-3) / (1 + 1e-3)
    EXPECT_NEAR(result.linear(0, 0).r, camera * 0.501f / 1.001f, 1e-7f);  // float rounding
    EXPECT_NEAR(result.linear(0, 0).g, camera * 0.251f / 1.001f, 1e-7f);
    EXPECT_EQ(result.linear(0, 0).b, camera);  // the channels are independent
    EXPECT_EQ(result.display(0, 0).b, 200);
}

TEST(Composite, AddsDirectAndIndirectLight) {
    const Photo photo = grey_photo(1, 1, 128);
    Layers split = untouched_layers(1, 1, 1.0f);
    split.indirect.e_r(0, 0) = Rgb(0.5f);
    split.indirect.e_rv_real(0, 0) = Rgb(0.25f);
    Layers joined = untouched_layers(1, 1, 1.5f);
    joined.direct.e_rv_real(0, 0) = Rgb(1.25f);
    EXPECT_EQ(composite(photo, split).linear(0, 0), composite(photo, joined).linear(0, 0));
}

TEST(Composite, ShowsTheVirtualObjectAlone) {
    const Photo photo = grey_photo(1, 1, 128);
    Layers layers = untouched_layers(1, 1, 0.0f);
    layers.m(0, 0) = 0;
    layers.k_v(0, 0) = Rgb(0.7f / std::numbers::pi_v<float>);
    layers.s_rv(0, 0) = {0.1f, 0.0f, 0.2f};
    layers.direct.e_rv_virtual(0, 0) = Rgb(std::numbers::pi_v<float>);
    const Composite result = composite(photo, layers);
    // a diffuse surface of reflectance 0.7 under radiance 1, plus the glossy part
    EXPECT_NEAR(result.linear(0, 0).r, 0.8f, 1e-6f);
    EXPECT_NEAR(result.linear(0, 0).g, 0.7f, 1e-6f);
    EXPECT_NEAR(result.linear(0, 0).b, 0.9f, 1e-6f);
    EXPECT_EQ(result.virtual_pixels, 1u);
    EXPECT_EQ(result.influenced_pixels, 1u);
}

/// Half of the pixel is a virtual object: two real samples with E_R = 1 and E_RV = 0.8, two virtual
/// ones with E_RV = 0.3, k_V = 0.7 / pi.
Layers silhouette(float e_rv_real) {
    Layers layers = untouched_layers(1, 1, 1.0f);
    layers.m(0, 0) = 0.5f;
    layers.k_v(0, 0) = Rgb(0.7f / std::numbers::pi_v<float>);
    layers.direct.e_rv_real(0, 0) = Rgb(e_rv_real);
    layers.direct.e_rv_virtual(0, 0) = Rgb(0.3f);
    return layers;
}

TEST(Composite, SilhouettesNeedSeparateAccumulators) {
    Photo photo = grey_photo(1, 1, 188);
    photo.linear(0, 0) = Rgb(0.5f);
    const double virtual_part = 0.5 * 0.7 / std::numbers::pi * 0.3;
    const double right = virtual_part + 0.5 * 0.8 * 0.5;  // 0.2334
    // epsilon moves the ratio 0.8 by 0.2 / 1001
    EXPECT_NEAR(composite(photo, silhouette(0.8f)).linear(0, 0).r, right, 1e-4);
    // as printed, E_RV is summed over all four samples and E_R over two: the ratio becomes
    // (1.6 + 0.6) / 2 = 1.1, a bright edge where a shadow falls
    EXPECT_GT(composite(photo, silhouette(1.1f)).linear(0, 0).r, right + 0.07);
}

TEST(Composite, CountsPartlyCoveredPixelsAsVirtual) {
    const Photo photo = grey_photo(3, 1, 128);
    Layers layers = untouched_layers(3, 1, 1.0f);
    layers.m.pixels = {1.0f, 0.75f, 0.0f};
    EXPECT_EQ(composite(photo, layers).virtual_pixels, 2u);
}

TEST(Composite, TakesEmptyLayersForZero) {
    const Photo photo = grey_photo(4, 3, 90);
    Layers layers;
    layers.m = Image<float>(4, 3, 1.0f);
    EXPECT_EQ(composite(photo, layers).display.pixels, photo.encoded.pixels);
    layers.m(2, 1) = 0;
    EXPECT_EQ(composite(photo, layers).linear(2, 1), Rgb(0));
}

TEST(Composite, ReplacesWhatIsNotFiniteByThePhotographAndCountsIt) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const Photo photo = grey_photo(5, 1, 90);
    Layers layers = untouched_layers(5, 1, 1.0f);
    layers.m(0, 0) = nan;
    layers.direct.e_r(1, 0) = Rgb(nan);
    layers.indirect.e_rv_real(2, 0) = {0, infinity, 0};
    layers.s_rv(3, 0) = {nan, 0, 0};
    const Composite result = composite(photo, layers);
    EXPECT_EQ(result.replaced_pixels, 4u);
    EXPECT_EQ(result.display.pixels, photo.encoded.pixels);
    EXPECT_EQ(result.linear.pixels, photo.linear.pixels);
}

TEST(Composite, DoesNotDependOnTheNumberOfThreads) {
    const Photo photo = grey_photo(61, 47, 133);
    Layers layers = untouched_layers(61, 47, 1.0f);
    for (std::size_t i = 0; i < layers.m.pixels.size(); ++i) {
        const SampleKey key{.pixel = std::uint32_t(i)};
        layers.direct.e_r.pixels[i] = Rgb(uniform(key, 0));
        layers.direct.e_rv_real.pixels[i] = Rgb(uniform(key, 1));
        layers.m.pixels[i] = uniform(key, 2);
    }
    const Composite all = composite(photo, layers);
    set_thread_count(1);
    const Composite one = composite(photo, layers);
    set_thread_count(0);
    EXPECT_EQ(all.linear.pixels, one.linear.pixels);
    EXPECT_EQ(all.display.pixels, one.display.pixels);
    EXPECT_EQ(all.influenced_pixels, one.influenced_pixels);
}

TEST(Composite, RefusesSizesThatDiffer) {
    const Photo photo = grey_photo(4, 4, 90);
    EXPECT_THROW(composite(photo, untouched_layers(4, 3, 1.0f)), Error);
    Layers layers = untouched_layers(4, 4, 1.0f);
    layers.indirect.e_r = Image<Rgb>(2, 2);
    EXPECT_THROW(composite(photo, layers), Error);
}

TEST(BlendSettings, RefuseWhatWouldNotBound) {
    EXPECT_THROW(validate(BlendSettings{.epsilon_share = 0}), Error);
    EXPECT_THROW(validate(BlendSettings{.max_ratio = 0.5f}), Error);
    EXPECT_THROW(validate(BlendSettings{.max_ratio = std::nanf("")}), Error);
    EXPECT_NO_THROW(validate(BlendSettings{}));
}

}  // namespace
}  // namespace inlay
