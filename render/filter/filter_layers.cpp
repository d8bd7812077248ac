// One run of the axis-aligned filter for each kind of receiver and of light.
#include "render/filter/filter_layers.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "render/filter/layer_sizes.h"
#include "render/filter/receiver_planes.h"
#include "render/filter/sampled_change.h"
#include "render/filter/shadow_ratio.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace inlay {
namespace {

/// A kind of receiver in this frame and, resampled to this frame's pixels, in the previous one.
struct Receivers {
    PreparedReceiver now, previous;
    Image<std::int32_t> source;  // of `previous`; empty: none
};

/// The receiver, cleaned, with the rates that its neighbors know.
Receiver completed(const Receiver& receiver, const FilterSettings& settings) {
    Receiver result = cleaned(receiver);
    if (settings.constants != FilterConstants::corrected || settings.rate_reach == 0) return result;
    for (Image<float> Receiver::*rates : {&Receiver::occluder_direct, &Receiver::occluder_indirect})
        result.*rates = filled_rates(result.*rates, result.object, settings.rate_reach);
    return result;
}

/// Curvature changes E_R and E_RV alike, so where only their ratio counts it need not bound the
/// width: the shadow ratio, with E_R as the unshadowed light. Where E_R and the change have widths
/// of their own, this holds where both are narrow. The normal stop bounds what mixes.
bool ignores_curvature(Receiver NoisyLayers::*kind, const FilterSettings& settings) {
    return kind == &NoisyLayers::real && !settings.real_curvature &&
           settings.constants == FilterConstants::corrected;
}

Receivers prepare(const NoisyLayers& now, const NoisyLayers* previous, Receiver NoisyLayers::*kind,
                  const FilterSettings& settings) {
    Receivers result;
    if (!any_object(now.*kind)) return result;
    result.now = prepare(completed(now.*kind, settings), now.lens, now.world_from_camera);
    if (ignores_curvature(kind, settings))
        result.now.curvature = {Image<float>(now.lens.width, now.lens.height),
                                Image<float>(now.lens.width, now.lens.height)};
    if (previous == nullptr || result.now.empty || (previous->*kind).object.empty()) return result;
    const Receiver before = completed(previous->*kind, settings);
    result.source = matching_pixels(result.now, now.world_from_camera, *previous, before, settings);
    result.previous = resampled(result.now, before, result.source);
    return result;
}

/// As `real`, for the change E_RV - E_R.
Receivers prepare_change(const NoisyLayers& now, const NoisyLayers* previous, const Receivers& real,
                         const FilterSettings& settings) {
    Receivers result = real;
    if (real.now.empty) return result;
    result.now.receiver = completed(receiver_of_change(now), settings);
    if (previous != nullptr && !real.source.empty())
        result.previous =
            resampled(result.now, completed(receiver_of_change(*previous), settings), real.source);
    return result;
}

Image<Rgb> rgb_of(const std::vector<Image<float>>& channels, std::size_t first) {
    Image<Rgb> result(channels[first].width, channels[first].height, Rgb(0));
    parallel_rows(result.height, [&](int y) {
        for (int x = 0; x < result.width; ++x)
            result(x, y) = {channels[first](x, y), channels[first + 1](x, y),
                            channels[first + 2](x, y)};
    });
    return result;
}

Image<float> mean_inverse_width(const FilterPlanes& planes) {
    Image<float> result(planes.object.width, planes.object.height, 0.0f);
    parallel_rows(result.height, [&](int y) {
        for (int x = 0; x < result.width; ++x)
            result(x, y) =
                0.5f * (std::sqrt(planes.precision_x(x, y)) + std::sqrt(planes.precision_y(x, y)));
    });
    return result;
}

struct Smoothed {
    std::vector<Image<float>> channels;
    Image<float> inverse_width;
};

KernelSettings kernel_of(const FilterSettings& settings) {
    return {settings.kernel_radius,
            float(std::cos(settings.normal_stop_deg * std::numbers::pi / 180))};
}

using Images = std::span<const Image<Rgb>* const>;

/// Smooths `images` with one width; `before` are the same of the previous frame.
Smoothed smooth(const Receivers& receivers, Images images, Images before,
                std::array<LightLimits, 2> limits, const FilterSettings& settings) {
    FilterPlanes now = planes_of(receivers.now, images, nullptr);
    set_precision(now, receivers.now, limits[0], settings);
    Image<float> width = mean_inverse_width(now);
    if (receivers.previous.empty || before.empty())
        return {filter_axis_aligned(std::move(now), nullptr, kernel_of(settings)),
                std::move(width)};
    FilterPlanes previous = planes_of(receivers.previous, before, &receivers.source);
    set_precision(previous, receivers.previous, limits[1], settings);
    return {filter_axis_aligned(std::move(now), &previous, kernel_of(settings)), std::move(width)};
}

/// The two frames at hand and what holds for both.
struct Frames {
    const NoisyLayers& now;
    const NoisyLayers* previous;
    double environment_bandwidth;
    const FilterSettings& settings;
    const EnvironmentIrradiance* open_sky;  // null: irradiance is smoothed, not the shadow ratio
    Receivers real, virtual_;
    Receivers change;  // as `real`, with the rates of the change; empty unless sampled for itself
};

using Layer = Image<Rgb> Irradiance::*;

const Irradiance& light_of(const NoisyLayers& layers, LightKind kind) {
    return kind == LightKind::direct ? layers.direct : layers.indirect;
}

/// px, lower bound of sigma. With more samples it falls as the width itself does, but not for light
/// whose two modes share their noise: there it must hide what few bright samples leave (a hot texel
/// behind an occluder's edge).
double narrowest_width(const NoisyLayers& frame, bool real, const FilterSettings& settings) {
    const bool shared = real && !sampled_apart(frame);
    return settings.narrowest_width *
           (shared ? 1.0 : std::min(1.0, sample_factor(frame.samples, settings)));
}

/// Smooths the named layers of one kind of light; returns 1 / sigma per pixel.
Image<float> smooth_light(const Frames& frames, const Receivers& receivers,
                          std::span<const Layer> layers, LightKind kind, Layers& result) {
    const bool is_direct = kind == LightKind::direct;
    Irradiance& out = is_direct ? result.direct : result.indirect;
    const bool as_ratio = is_direct && frames.open_sky != nullptr;
    const bool real = &receivers == &frames.real;
    // E_R that was sampled for itself has little noise, and stays one frame's: what the frame
    // before did not need, it need not have.
    const NoisyLayers* previous = real && sampled_apart(frames.now) ? nullptr : frames.previous;
    std::vector<const Image<Rgb>*> now, before;
    for (const Layer layer : layers) {
        now.push_back(&(light_of(frames.now, kind).*layer));
        if (previous != nullptr) before.push_back(&(light_of(*previous, kind).*layer));
    }
    if (as_ratio) {
        const auto unshadowed = real ? &Unshadowed::real : &Unshadowed::virtual_;
        now.push_back(&(frames.now.unshadowed.*unshadowed));
        if (previous != nullptr) before.push_back(&(previous->unshadowed.*unshadowed));
    }
    if (receivers.now.empty) {
        for (const Layer layer : layers)
            out.*layer = Image<Rgb>(frames.now.lens.width, frames.now.lens.height, Rgb(0));
        return Image<float>(frames.now.lens.width, frames.now.lens.height);
    }
    const auto limits_of = [&](const NoisyLayers& frame) {
        return LightLimits{kind,
                           frames.environment_bandwidth,
                           nullptr,
                           real ? frame.samples : samples_on_virtual(frame),
                           narrowest_width(frame, real, frames.settings),
                           as_ratio};
    };
    const LightLimits limits = limits_of(frames.now);
    const LightLimits limits_before = previous ? limits_of(*previous) : limits;
    const Smoothed smoothed =
        smooth(receivers, now, before, {limits, limits_before}, frames.settings);
    for (std::size_t i = 0; i < layers.size(); ++i)
        out.*layers[i] = rgb_of(smoothed.channels, 3 * i);
    if (!as_ratio) return smoothed.inverse_width;
    const Image<Rgb> unshadowed = rgb_of(smoothed.channels, 3 * layers.size());
    for (const Layer layer : layers)
        scale_to_open_sky(*frames.open_sky, receivers.now.receiver, unshadowed, out.*layer);
    return smoothed.inverse_width;
}

Image<float> of_larger_cover(const Image<float>& m, const Image<float>& real,
                             const Image<float>& of_virtual) {
    Image<float> result(m.width, m.height, 0.0f);
    for (std::size_t i = 0; i < result.pixels.size(); ++i)
        result.pixels[i] = m.pixels[i] > 0.5f ? real.pixels[i] : of_virtual.pixels[i];
    return result;
}

/// Smooths E_R and the change apart, each with its own width; returns 1 / sigma of the change.
Image<float> smooth_difference(const Frames& frames, LightKind kind, Layers& result) {
    smooth_light(frames, frames.real, std::array<Layer, 1>{&Irradiance::e_r}, kind, result);
    Irradiance& out = kind == LightKind::direct ? result.direct : result.indirect;
    out.e_rv_real = out.e_r;
    if (frames.real.now.empty) return Image<float>(out.e_r.width, out.e_r.height);
    const Image<Rgb> now = change_of(light_of(frames.now, kind));
    const Image<Rgb> before =
        frames.previous != nullptr ? change_of(light_of(*frames.previous, kind)) : Image<Rgb>{};
    const std::array<const Image<Rgb>*, 1> images{&now}, images_before{&before};
    const auto limits_of = [&](const NoisyLayers& frame) {
        return LightLimits{
            kind, frames.environment_bandwidth, nullptr, frame.samples,
            frames.settings.narrowest_change * sample_factor(frame.samples, frames.settings)};
    };
    const LightLimits limits = limits_of(frames.now);
    const LightLimits limits_before = frames.previous ? limits_of(*frames.previous) : limits;
    const Smoothed smoothed =
        smooth(frames.change, images, frames.previous != nullptr ? Images(images_before) : Images{},
               {limits, limits_before}, frames.settings);
    out.e_rv_real = with_change(out.e_r, rgb_of(smoothed.channels, 0));
    return smoothed.inverse_width;
}

/// Smooths both kinds of receiver; returns 1 / sigma of the kind that covers more of each pixel.
Image<float> smooth_both(const Frames& frames, LightKind kind, Layers& result) {
    constexpr std::array<Layer, 2> on_real{&Irradiance::e_r, &Irradiance::e_rv_real};
    constexpr std::array<Layer, 1> on_virtual{&Irradiance::e_rv_virtual};
    Image<float> real = sampled_apart(frames.now)
                            ? smooth_difference(frames, kind, result)
                            : smooth_light(frames, frames.real, on_real, kind, result);
    if (frames.now.k_v.empty()) return real;  // no virtual surface is seen
    const Image<float> of_virtual = smooth_light(frames, frames.virtual_, on_virtual, kind, result);
    return of_larger_cover(frames.now.m, real, of_virtual);
}

/// S_RV where a glossy surface is seen; elsewhere it stays as it is on virtual surfaces, and 0 off
/// them.
void smooth_glossy(const Frames& frames, Layers& result) {
    const NoisyLayers& now = frames.now;
    if (now.s_rv.empty()) return;
    if (frames.virtual_.now.empty) {
        result.s_rv = Image<Rgb>(now.lens.width, now.lens.height, Rgb(0));
        return;
    }
    const Image<std::uint32_t>& object = frames.virtual_.now.receiver.object;
    Receivers glossy{frames.virtual_.now, {}, {}};
    bool any = false;
    for (std::size_t i = 0; i < object.pixels.size(); ++i) {
        const bool is_glossy = object.pixels[i] != 0 && now.glossy_bandwidth.pixels[i] != 0;
        if (object.pixels[i] == 0) result.s_rv.pixels[i] = Rgb(0);
        if (!is_glossy) glossy.now.receiver.object.pixels[i] = 0;
        any = any || is_glossy;
    }
    if (!any) return;
    const std::array<const Image<Rgb>*, 1> images{&now.s_rv};
    // A highlight may be a pixel wide: where the width says so, it is left alone.
    const LightLimits limits{LightKind::direct, frames.environment_bandwidth, &now.glossy_bandwidth,
                             samples_on_virtual(now), 0};
    const Image<Rgb> values =
        rgb_of(smooth(glossy, images, {}, {limits, limits}, frames.settings).channels, 0);
    for (std::size_t i = 0; i < object.pixels.size(); ++i)
        if (glossy.now.receiver.object.pixels[i] != 0) result.s_rv.pixels[i] = values.pixels[i];
}

}  // namespace

Layers filter_layers(const NoisyLayers& now, const NoisyLayers* previous,
                     double environment_bandwidth, const FilterSettings& settings,
                     const EnvironmentIrradiance* open_sky) {
    validate(settings);
    require(std::isfinite(environment_bandwidth) && environment_bandwidth >= 0,
            "environment bandwidth is " + std::to_string(environment_bandwidth) +
                ", expected 0 or more, finite");
    require(std::isfinite(now.lens.fx) && std::isfinite(now.lens.fy) && now.lens.fx != 0 &&
                now.lens.fy != 0,
            "noisy layers: a focal length of the lens is 0 or not finite");
    require_layer_sizes(now);
    if (open_sky != nullptr) require_unshadowed(now);
    const Image<float> blank(now.lens.width, now.lens.height, 0.0f);
    if (!settings.enabled || blank.empty())
        return {now.m, now.k_v, now.s_rv, now.direct, now.indirect, blank, blank};
    if (!settings.temporal) previous = nullptr;
    if (previous != nullptr) require_layer_sizes(*previous);
    if (previous != nullptr && sampled_apart(*previous) != sampled_apart(now))
        previous = nullptr;  // its rates say something else
    if (previous != nullptr && open_sky != nullptr) require_unshadowed(*previous);
    Frames frames{now,
                  previous,
                  environment_bandwidth,
                  settings,
                  open_sky,
                  prepare(now, previous, &NoisyLayers::real, settings),
                  prepare(now, previous, &NoisyLayers::virtual_, settings),
                  {}};
    if (sampled_apart(now)) frames.change = prepare_change(now, previous, frames.real, settings);
    Layers result{now.m, now.k_v, now.s_rv, {}, {}, {}, {}};
    result.bandwidth_direct = smooth_both(frames, LightKind::direct, result);
    result.bandwidth_indirect = smooth_both(frames, LightKind::indirect, result);
    smooth_glossy(frames, result);
    return result;
}

}  // namespace inlay
