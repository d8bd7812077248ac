// PixelSums: what a pixel's samples add up to, real and virtual receivers apart, each with a count
// of its own (Algorithm 1's sums mix them, which brightens silhouettes).
#pragma once

#include "render/trace/layers.h"
#include "render/trace/two_mode_sampler.h"

#include <glm/glm.hpp>

#include <cmath>

namespace inlay {

/// A sum over samples that leaves out the non-finite ones and counts them.
struct SampleSum {
    glm::dvec3 sum{0.0};
    int count = 0, dropped = 0;

    /// Whether the value was finite, and so is part of the sum.
    bool add(const Rgb& value) {
        if (!std::isfinite(value.r + value.g + value.b)) {
            ++dropped;
            return false;
        }
        sum += glm::dvec3(value);
        ++count;
        return true;
    }
    Rgb mean() const { return count > 0 ? Rgb(sum / double(count)) : Rgb(0); }
};

/// The same sample in both modes: dropped in both if either is not finite.
struct PairedSum {
    SampleSum e_r, e_rv;

    void add(const Rgb& real_only, const Rgb& with_virtual) {
        const bool finite = std::isfinite(real_only.r + real_only.g + real_only.b + with_virtual.r +
                                          with_virtual.g + with_virtual.b);
        e_r.add(finite ? real_only : Rgb(NAN));
        e_rv.add(finite ? with_virtual : Rgb(NAN));
    }
};

struct ReceiverSums {
    int hits = 0;              // primary samples on this kind of surface
    std::uint32_t object = 0;  // of the first of them; as in Receiver
    glm::dvec3 position{0.0}, normal{0.0};
    float occluder_direct = 0, occluder_indirect = 0;  // largest cos/r, 1/m
};

/// E_RV - E_R, and how fast it may vary.
struct ChangeSums {
    int camera_rays = 0, dropped = 0;
    float cone_tries = 0;                      // of one half, on average over their roundings
    glm::dvec3 direct{0.0}, indirect{0.0};     // each sample over the samples of its camera ray
    double hidden = 0;                         // cos / p over directions where virtual is nearest
    float rate_direct = 0, rate_indirect = 0;  // largest cos/r of virtual surfaces, 1/m

    /// Leaves out, and counts, what is not finite.
    void add(glm::dvec3 ChangeSums::*light, const Rgb& value) {
        if (std::isfinite(value.r + value.g + value.b))
            this->*light += glm::dvec3(value);
        else
            ++dropped;
    }
};

struct PixelSums {
    int looks = 0, looks_virtual = 0;  // camera rays in all, and those that met virtual surfaces
    ReceiverSums real, virtual_;
    PairedSum direct, indirect;  // on real surfaces
    SampleSum direct_virtual, indirect_virtual, glossy_direct, glossy_indirect, albedo;
    SampleSum unshadowed_real, unshadowed_virtual;  // left empty unless asked for
    float glossy_bandwidth = 0;
    ChangeSums change;  // on real surfaces, where it is sampled for itself
};

/// Writes a pixel's means into the layers.
void store(const PixelSums& sums, int x, int y, NoisyLayers& layers);

/// Sets E_R, where it is sampled for itself, of a pixel that was stored without it, and adds it to
/// the change.
void store_real_light(const PixelSums& sums, int x, int y, NoisyLayers& layers);

/// Layers of `lens`'s size, all zero; of what `settings` says no camera ray meets, empty images.
NoisyLayers make_noisy_layers(const Lens& lens, const Pose& world_from_camera,
                              const SamplingSettings& settings);

/// Samples that were left out.
int dropped(const PixelSums& sums);

}  // namespace inlay
