// The exposure of photographs of a tiled wall, whose gains are known.
#include "slam/exposure/measure_exposure.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "recordings/base/random.h"
#include "slam/depth/surface_from_depth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace inlay {
namespace {

Lens wall_lens() { return {320, 240, 280, 280, 159.5, 119.5}; }

/// A wall 1.5 m in front of the camera, which does not move.
const SurfaceMap& wall() {
    static const SurfaceMap map =
        surface_from_depth(Image<float>(320, 240, 1.5f), wall_lens(), Pose{});
    return map;
}

float random(std::uint32_t seed, std::uint32_t place, std::uint32_t dimension) {
    return uniform({seed, 0, place, 0}, dimension);
}

/// Tiles of 24 x 24 px, 0.1..0.5 bright, a little tinted, and shaded by up to 20 % from left to
/// right so that bytes differ within a tile.
Image<Rgb> tiles(std::uint32_t seed = 1) {
    Image<Rgb> image(320, 240);
    for (int y = 0; y < 240; ++y) {
        for (int x = 0; x < 320; ++x) {
            const auto tile = std::uint32_t(y / 24 * 100 + x / 24);
            const float brightness = 0.1f + 0.4f * random(seed, tile, 0);
            for (int i = 0; i < 3; ++i) {
                const float tint = 0.8f + 0.4f * random(seed, tile, std::uint32_t(i) + 1);
                image(x, y)[i] = brightness * tint * (1 - 0.2f * float(x) / 320);
            }
        }
    }
    return image;
}

/// As a camera records it: `noise` is the standard deviation in bytes, near enough Gaussian.
Image<EncodedRgb> photograph(const Image<Rgb>& scene, const Rgb& gain, float noise = 0,
                             std::uint32_t seed = 2) {
    Image<EncodedRgb> photo(scene.width, scene.height);
    for (std::size_t i = 0; i < scene.pixels.size(); ++i) {
        const EncodedRgb clean = encode(gain * scene.pixels[i]);
        const auto noisy = [&](std::uint8_t byte, std::uint32_t channel) {
            float sum = -2;  // of four uniform numbers: variance 1/3
            for (std::uint32_t k = 0; k < 4; ++k)
                sum += random(seed, std::uint32_t(i), 4 * channel + k);
            const float value = float(byte) + noise * sum * std::sqrt(3.0f);
            return std::uint8_t(std::lround(std::fmin(255.0f, std::fmax(0.0f, value))));
        };
        photo.pixels[i] = {noisy(clean.r, 0), noisy(clean.g, 1), noisy(clean.b, 2)};
    }
    return photo;
}

void fuse(VoxelVolume& volume, const Image<EncodedRgb>& photo) {
    fuse_surface(volume, wall(), {photo, wall_lens(), Pose{}}, {});
}

/// The wall after some photographs at the first exposure.
VoxelVolume fused_wall(float noise = 0, int photographs = 1) {
    VoxelVolume volume = make_volume({});
    for (int i = 0; i < photographs; ++i)
        fuse(volume, photograph(tiles(), Rgb(1), noise, std::uint32_t(100 + i)));
    return volume;
}

Exposure measure(const VoxelVolume& volume, const Image<EncodedRgb>& photo) {
    return measure_exposure(volume, wall(), {photo, wall_lens(), Pose{}});
}

void expect_near(const Rgb& found, const Rgb& expected, float share) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i] / expected[i], 1, share) << "channel " << i;
}

void expect_unknown(const Exposure& exposure) {
    EXPECT_EQ(exposure.pixels, 0);
    EXPECT_EQ(exposure.gain, Rgb(1));
    EXPECT_EQ(exposure.measured, Rgb(1));
}

TEST(MeasureExposure, FindsTheGainOfAPhotograph) {
    const VoxelVolume volume = fused_wall();
    for (const float gain : {0.5f, 0.8f, 1.1f, 1.5f, 2.0f}) {
        const Exposure found = measure(volume, photograph(tiles(), Rgb(gain)));
        EXPECT_GT(found.pixels, 300);
        // Half a byte is 1.4 % of a tile of 0.05 and 0.4 % of one of 0.5; means over more than 100
        // tiles have less than a tenth of that, and the common gain has no bias at all.
        expect_near(found.measured, Rgb(gain), 0.005f);
        expect_near(found.gain, Rgb(gain), 0.005f);
        EXPECT_LT(found.uncertainty.g, 0.01f);
    }
}

TEST(MeasureExposure, IsExactlyOneWhileNothingChanges) {
    const VoxelVolume young = fused_wall(3), old = fused_wall(3, 10);
    for (std::uint32_t seed = 2; seed < 8; ++seed) {
        const Image<EncodedRgb> photo = photograph(tiles(), Rgb(1), 3, seed);
        for (const VoxelVolume* volume : {&young, &old}) {
            const Exposure found = measure(*volume, photo);
            EXPECT_GT(found.pixels, 300);
            EXPECT_EQ(found.gain, Rgb(1));
            // 3 bytes are 8 % of a tile of 0.1, 3 % of one of 0.5, and 1000 pixels tell.
            expect_near(found.measured, Rgb(1), 0.01f);
        }
    }
}

TEST(MeasureExposure, FindsTheWhiteBalance) {
    const Rgb gain(1.25f, 1.0f, 0.8f);
    const Exposure found = measure(fused_wall(2), photograph(tiles(), gain, 2));
    expect_near(found.gain, gain, 0.01f);  // as above, with noise
    const Rgb strong(1.4f, 1.0f, 0.7f);
    expect_near(measure(fused_wall(2), photograph(tiles(), strong, 2)).gain, strong, 0.01f);
}

TEST(MeasureExposure, BelievesOnlyAWhiteBalanceThatIsSignificant) {
    const Exposure found = measure(fused_wall(2), photograph(tiles(), Rgb(1.31f, 1.3f, 1.29f), 2));
    EXPECT_EQ(found.gain.r, found.gain.g);
    EXPECT_EQ(found.gain.b, found.gain.g);
    expect_near(found.gain, Rgb(1.3f), 0.01f);
}

TEST(MeasureExposure, ASlowChangeHasNoStep) {
    const VoxelVolume volume = fused_wall();
    float before = 1;
    for (float gain = 1; gain < 1.06f; gain += 0.002f) {
        const float found = measure(volume, photograph(tiles(), Rgb(gain))).gain.g;
        EXPECT_GE(found, before - 0.002f);  // noise of the quantisation
        EXPECT_LT(found - before, 0.012f);  // twice the change, and that noise
        before = found;
    }
    EXPECT_NEAR(before, 1.058f, 0.006f);
}

TEST(MeasureExposure, IsNotMisledByWhatCoversNearlyHalfOfTheImage) {
    const Image<Rgb> other = tiles(7);
    Image<Rgb> scene = tiles();
    for (int y = 0; y < 240; ++y)
        for (int x = 0; x < 150; ++x)
            scene(x, y) = other(x, y);
    // Chance ratios of two tiles spread over a factor of 5 to either side, some near the true one.
    const Exposure found = measure(fused_wall(2), photograph(scene, Rgb(1.4f), 2));
    expect_near(found.gain, Rgb(1.4f), 0.03f);
    const Exposure same = measure(fused_wall(2), photograph(scene, Rgb(1), 2));
    expect_near(same.gain, Rgb(1), 0.03f);
}

TEST(MeasureExposure, ClippedPixelsDoNotCount) {
    // Two fifths of the tiles clip, the sharpest ones the most.
    const Exposure found = measure(fused_wall(), photograph(tiles(), Rgb(2.5f)));
    expect_near(found.measured, Rgb(2.5f), 0.01f);
}

TEST(MeasureExposure, IsUnknownWhereNothingTells) {
    const VoxelVolume volume = fused_wall();
    expect_unknown(measure(volume, photograph(tiles(), Rgb(100))));
    expect_unknown(measure(volume, photograph(tiles(), Rgb(0))));
    expect_unknown(measure(volume, {}));
    expect_unknown(measure(make_volume({}), photograph(tiles(), Rgb(1))));
    VoxelVolume colorless = make_volume({});
    fuse_surface(colorless, wall(), {{}, wall_lens(), Pose{}}, {});
    expect_unknown(measure(colorless, photograph(tiles(), Rgb(1))));
    const Image<EncodedRgb> photo = photograph(tiles(), Rgb(1));
    expect_unknown(measure_exposure(volume, empty_surface_map(wall_lens(), Pose{}),
                                    {photo, wall_lens(), Pose{}}));
}

TEST(MeasureExposure, AChannelThatIsDarkGoesWithTheOthers) {
    Image<Rgb> red = tiles();
    for (Rgb& color : red.pixels)
        color.g = color.b = 0.001f;
    VoxelVolume volume = make_volume({});
    fuse(volume, photograph(red, Rgb(1)));
    expect_near(measure(volume, photograph(red, Rgb(1.5f))).gain, Rgb(1.5f), 0.01f);
}

TEST(MeasureExposure, SurvivesHolesAndSurfacesThatAreNoNumbers) {
    SurfaceMap damaged = wall();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = 0; i < damaged.position.pixels.size(); i += 7) {
        damaged.position.pixels[i] = i % 2 ? glm::vec3(0) : glm::vec3(nan);
        damaged.normal.pixels[i] = i % 2 ? glm::vec3(0) : glm::vec3(nan);
    }
    const Image<EncodedRgb> photo = photograph(tiles(), Rgb(1.5f));
    const Exposure found = measure_exposure(fused_wall(), damaged, {photo, wall_lens(), Pose{}});
    expect_near(found.gain, Rgb(1.5f), 0.01f);
}

TEST(MeasureExposure, APhotographOfAnotherSizeAndPlaceIsFoundByItsLens) {
    SurfaceMap half =
        surface_from_depth(Image<float>(160, 120, 1.5f), scaled(wall_lens(), 160, 120), Pose{});
    const Image<EncodedRgb> photo = photograph(tiles(), Rgb(0.7f));
    const Exposure found = measure_exposure(fused_wall(), half, {photo, wall_lens(), Pose{}});
    expect_near(found.gain, Rgb(0.7f), 0.01f);
}

TEST(MeasureExposure, RefusesALensThatIsNotThePhotographs) {
    const Image<EncodedRgb> photo(10, 10);
    EXPECT_THROW(measure_exposure(fused_wall(), wall(), {photo, wall_lens(), Pose{}}), Error);
}

TEST(MeasureExposure, GivesTheSameBytesForAnyNumberOfThreads) {
    const VoxelVolume volume = fused_wall(3);
    const Image<EncodedRgb> photo = photograph(tiles(), Rgb(1.2f, 1.1f, 1.3f), 3);
    set_thread_count(1);
    const Exposure one = measure(volume, photo);
    set_thread_count(3);
    const Exposure three = measure(volume, photo);
    set_thread_count(0);
    EXPECT_EQ(std::memcmp(&one, &three, sizeof one), 0);
}

}  // namespace
}  // namespace inlay
