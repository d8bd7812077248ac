// What tests assert about vectors and layers; NaN never passes.
#pragma once

#include "render/trace/layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace inlay::test {

/// |a - b| <= tolerance in every component.
inline ::testing::AssertionResult near(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
    const glm::dvec3 off = glm::abs(a - b);
    if (off.x <= tolerance && off.y <= tolerance && off.z <= tolerance)
        return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure()
           << "(" << a.x << ", " << a.y << ", " << a.z << ") is not within " << tolerance << " of ("
           << b.x << ", " << b.y << ", " << b.z << ")";
}

inline bool sound(float x) { return std::isfinite(x) && x >= 0; }
inline bool sound(const Rgb& c) { return sound(c.r) && sound(c.g) && sound(c.b); }

/// Whether every pixel is finite and >= 0.
template <class Pixel>
::testing::AssertionResult sound(const Image<Pixel>& image, const char* name) {
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            if (!sound(image(x, y)))
                return ::testing::AssertionFailure() << name << " at (" << x << ", " << y << ")";
        }
    }
    return ::testing::AssertionSuccess();
}

/// Before it is filtered, E_R plus a change that was sampled for itself may be negative.
inline void expect_sound(const Irradiance& e, bool change_apart = false) {
    EXPECT_TRUE(sound(e.e_r, "e_r"));
    if (change_apart) {
        for (const Rgb& c : e.e_rv_real.pixels)
            EXPECT_TRUE(std::isfinite(c.r + c.g + c.b)) << "e_rv_real";
    } else {
        EXPECT_TRUE(sound(e.e_rv_real, "e_rv_real"));
    }
    EXPECT_TRUE(sound(e.e_rv_virtual, "e_rv_virtual"));
}

inline void expect_sound(const Receiver& r) {
    EXPECT_TRUE(sound(r.occluder_direct, "occluder_direct"));
    EXPECT_TRUE(sound(r.occluder_indirect, "occluder_indirect"));
    for (std::size_t i = 0; i < r.object.pixels.size(); ++i) {
        if (r.object.pixels[i] == 0) continue;
        const glm::vec3 p = r.position.pixels[i];
        EXPECT_TRUE(std::isfinite(p.x + p.y + p.z)) << "position of pixel " << i;
        EXPECT_NEAR(glm::length(r.normal.pixels[i]), 1, 1e-5) << "normal of pixel " << i;
    }
}

/// Everything finite, nothing negative, M within 0..1.
inline void expect_sound(const NoisyLayers& layers) {
    EXPECT_TRUE(sound(layers.m, "M"));
    for (const float m : layers.m.pixels)
        EXPECT_LE(m, 1);
    EXPECT_TRUE(sound(layers.k_v, "k_V"));
    EXPECT_TRUE(sound(layers.s_rv, "S_RV"));
    EXPECT_TRUE(sound(layers.glossy_bandwidth, "glossy_bandwidth"));
    const bool change_apart = !layers.change_rates.direct.empty();
    expect_sound(layers.direct, change_apart);
    expect_sound(layers.indirect, change_apart);
    EXPECT_TRUE(sound(layers.change_rates.direct, "change_rates.direct"));
    EXPECT_TRUE(sound(layers.change_rates.indirect, "change_rates.indirect"));
    EXPECT_TRUE(sound(layers.change_rates.share, "change_rates.share"));
    expect_sound(layers.real);
    expect_sound(layers.virtual_);
}

template <class Pixel>
bool same_bytes(const Image<Pixel>& a, const Image<Pixel>& b) {
    return same_size(a, b) &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Pixel)) == 0;
}

inline bool same_bytes(const Irradiance& a, const Irradiance& b) {
    return same_bytes(a.e_r, b.e_r) && same_bytes(a.e_rv_real, b.e_rv_real) &&
           same_bytes(a.e_rv_virtual, b.e_rv_virtual);
}

inline bool same_bytes(const Receiver& a, const Receiver& b) {
    return same_bytes(a.object, b.object) && same_bytes(a.position, b.position) &&
           same_bytes(a.normal, b.normal) && same_bytes(a.occluder_direct, b.occluder_direct) &&
           same_bytes(a.occluder_indirect, b.occluder_indirect);
}

inline bool same_bytes(const NoisyLayers& a, const NoisyLayers& b) {
    return same_bytes(a.m, b.m) && same_bytes(a.k_v, b.k_v) && same_bytes(a.s_rv, b.s_rv) &&
           same_bytes(a.glossy_bandwidth, b.glossy_bandwidth) && same_bytes(a.direct, b.direct) &&
           same_bytes(a.indirect, b.indirect) &&
           same_bytes(a.change_rates.direct, b.change_rates.direct) &&
           same_bytes(a.change_rates.indirect, b.change_rates.indirect) &&
           same_bytes(a.change_rates.share, b.change_rates.share) &&
           same_bytes(a.sampled_real, b.sampled_real) && same_bytes(a.real, b.real) &&
           same_bytes(a.virtual_, b.virtual_);
}

}  // namespace inlay::test
