#include "composite/govern/measure_front.h"

#include "composite/accuracy/error_estimate.h"
#include "composite/session/obey_plan.h"
#include "composite/session/stop_watch.h"
#include "render/filter/filter_layers.h"

#include <utility>

namespace inlay {
namespace {

constexpr std::uint32_t seed_offset = 0x90e4;  // numbers of no frame that is shown
constexpr int measured_samples[] = {4, 8, 16, 32, 64};
constexpr int raw_samples = 32;  // of each picture that errors are estimated against: their noise
                                 // drops out of the mean, and averages out over the pixels; the
                                 // bias of their ratio stays, so that small errors look larger

struct Trial {
    Image<Rgb> linear;
    double ms = 0;  // sampling and filtering
};

Trial picture_of(const FrameAtHand& f, const Photo& photo, const SamplingSettings& sampling,
                 const FilterSettings& filter) {
    StopWatch watch;
    const TwoModeResult sampled = sample(f.session, *f.out.real, f.frame, f.out.plan, sampling);
    const Layers layers = planned_layers(f.out.plan, {&sampled.layers, nullptr}, photo.linear,
                                         f.session.environment_bandwidth, filter);
    const double ms = watch.lap();
    return {composite(photo, layers, f.session.settings.blend).linear, ms};
}

/// Two pictures of independent two-mode samples, as they are: a ratio of few samples has its right
/// mean only if both modes share their noise.
struct RawPair {
    Image<Rgb> a, b;
};

RawPair raw_pair(const FrameAtHand& f, const Photo& photo) {
    const Settings& settings = f.session.settings;
    SamplingSettings sampling = with_samples(settings.trace, raw_samples);
    sampling.estimator = Estimator::two_mode;
    FilterSettings unfiltered = settings.filter;
    unfiltered.enabled = false;
    const auto raw = [&](std::uint32_t which) {
        sampling.seed = settings.trace.seed + seed_offset + which;
        const TwoModeResult sampled = sample(f.session, *f.out.real, f.frame, f.out.plan, sampling);
        return composite(photo, filter_layers(sampled.layers, nullptr, 0, unfiltered),
                         settings.blend)
            .linear;
    };
    return {raw(1), raw(2)};
}

/// Pixels whose written bytes are not the recorded ones.
Mask changed_pixels(const FrameAtHand& f) {
    const Image<EncodedRgb>& display = f.out.composite.display;
    Mask mask(display.width, display.height);
    for (std::size_t i = 0; i < display.pixels.size(); ++i)
        mask.pixels[i] = display.pixels[i] != f.frame.color.pixels[i];
    return mask;
}

}  // namespace

bool shows_anything(const OutputFrame& out) {
    return out.real && out.composite.influenced_pixels > 0;
}

double price_of_samples(const OutputFrame& out) {
    const bool for_later = 10 * out.gathering.total() > out.rays.total();
    return for_later ? 0 : out.ms.trace + out.ms.filter;
}

PriceFront measure_front(const FrameAtHand& f) {
    PriceFront front;
    if (!shows_anything(f.out)) return front;
    const Photo photo = linearise(f.frame.color, f.out.exposure);
    const Mask mask = changed_pixels(f);
    const RawPair raw = raw_pair(f, photo);
    for (const int samples : measured_samples) {
        SamplingSettings sampling = with_samples(f.session.settings.trace, samples);
        sampling.seed += seed_offset;
        const Trial picture = picture_of(f, photo, sampling, f.session.settings.filter);
        const double error = estimate_error(picture.linear, raw.a, raw.b, mask, 0).rmse;
        if (error > 0) front.points.push_back({samples, picture.ms, error});
    }
    front.points = pareto(std::move(front.points));
    return front;
}

std::optional<double> estimate_error_factor(const FrameAtHand& f, const PriceFront& front) {
    if (!shows_anything(f.out)) return std::nullopt;
    const Photo photo = linearise(f.frame.color, f.out.exposure);
    const RawPair raw = raw_pair(f, photo);
    SamplingSettings sampling = f.session.settings.trace;
    sampling.seed += seed_offset;
    const Trial picture = picture_of(f, photo, sampling, f.session.settings.filter);
    const double error = estimate_error(picture.linear, raw.a, raw.b, changed_pixels(f), 0).rmse;
    if (!(error > 0)) return std::nullopt;  // lost in the noise of the raw pictures
    return error / error_at(front, sampling.primary * sampling.secondary);
}

}  // namespace inlay
