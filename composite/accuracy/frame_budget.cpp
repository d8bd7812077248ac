#include "composite/accuracy/frame_budget.h"

#include "composite/blend/differential.h"
#include "recordings/base/check.h"
#include "render/filter/filter_layers.h"
#include "render/trace/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace inlay {
namespace {

/// A picture moved by a fraction of its pixels along (1, 1) / sqrt 2, bilinear, its border
/// repeated.
Image<Rgb> moved(const Image<Rgb>& image, double px) {
    const auto at = [&](int x, int y) {
        return image(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1));
    };
    const double step = px / std::sqrt(2.0);
    const int whole = int(std::floor(step));
    const auto part = float(step - whole);
    Image<Rgb> result(image.width, image.height);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const int u = x + whole, v = y + whole;
            const Rgb top = glm::mix(at(u, v), at(u + 1, v), part);
            const Rgb bottom = glm::mix(at(u, v + 1), at(u + 1, v + 1), part);
            result(x, y) = glm::mix(top, bottom, part);
        }
    }
    return result;
}

double influenced_rmse(const Reference& reference, const Image<Rgb>& picture) {
    return std::sqrt(error_against(reference, picture, encode(picture)).mean_square_influenced);
}

/// Sums of squares of one irradiance against its reference, where real surfaces fill the pixel.
double relative_rmse(const Layers& layers, const Layers& reference, Image<Rgb> Irradiance::*kind) {
    double error = 0, power = 0;
    for (std::size_t i = 0; i < layers.m.pixels.size(); ++i) {
        if (layers.m.pixels[i] < 1 || reference.m.pixels[i] < 1) continue;
        const Rgb found = (layers.direct.*kind).pixels[i] + (layers.indirect.*kind).pixels[i];
        const Rgb wanted =
            (reference.direct.*kind).pixels[i] + (reference.indirect.*kind).pixels[i];
        if (wanted == Rgb(0) || found == Rgb(0)) continue;  // a hole of one of the surfaces
        error += double(glm::dot(found - wanted, found - wanted));
        power += double(glm::dot(wanted, wanted));
    }
    return power > 0 ? std::sqrt(error / power) : 0;
}

/// The frame reconstructed without sensor noise or tracking.
TrackedFrame seen_room(const Work& work, int frame, const Settings& settings) {
    Settings posed = settings;
    posed.use_recorded_poses = true;
    return track_frames(work, {frame}, posed, SensorDepth::exact).at(0);
}

}  // namespace

Layers light_of(const Work& work, const TrackedFrame& frame, const Settings& settings,
                int converged_samples) {
    SamplingSettings sampling = settings.trace;
    FilterSettings filter = settings.filter;
    if (converged_samples > 0) {
        sampling = many_samples(sampling, converged_samples);
        filter.enabled = false;
    }
    const SampledFrame sampled = sample_frame(work, frame, sampling, std::uint32_t(frame.frame));
    return filter_layers(sampled.result.layers, nullptr, work.environment_bandwidth, filter);
}

IrradianceError irradiance_error(const Layers& layers, const Layers& reference) {
    std::size_t covered = 0, lit = 0;
    for (std::size_t i = 0; i < layers.m.pixels.size(); ++i) {
        if (layers.m.pixels[i] < 1 || reference.direct.e_r.pixels[i] == Rgb(0)) continue;
        ++covered;
        if (layers.direct.e_r.pixels[i] != Rgb(0)) ++lit;
    }
    return {relative_rmse(layers, reference, &Irradiance::e_r),
            relative_rmse(layers, reference, &Irradiance::e_rv_real),
            covered > 0 ? double(lit) / double(covered) : 0.0};
}

double displacement_px(const Work& work, const TrackedFrame& frame, const Pose& true_pose) {
    require(work.knows_room && frame.room != nullptr, work.name + ": its true room is unknown");
    const EmbreeScene room = EmbreeSceneCache().place(work.scene, frame.time, /*real=*/true);
    const Image<float> depth = trace_depth(room, frame.lens, true_pose);
    const SurfaceMap& surface = *frame.room->surface;
    // Where a true point is seen from the pose that was found, and how far the model's depth moves
    // what it casts: a length on the surface is as long in the image as one across the view.
    double sum = 0;
    int count = 0;
    for (int y = 0; y < depth.height; ++y) {
        for (int x = 0; x < depth.width; ++x) {
            const float z = depth(x, y);
            if (z <= 0 || !surface.has_surface(x, y)) continue;
            const glm::dvec3 world = true_pose * (double(z) * unproject(frame.lens, {x, y}));
            const glm::dvec3 seen = inverse(frame.world_from_camera) * world;
            if (!(seen.z > 0)) continue;
            const double off = glm::length(project(frame.lens, seen) - glm::dvec2(x, y));
            const double error = double(surface.position(x, y).z) - seen.z;
            if (std::abs(error) > 0.05 * double(z)) continue;  // another surface: an edge
            const double cast = frame.lens.fx * std::abs(error) / double(z);
            sum += off * off + cast * cast;
            ++count;
        }
    }
    return count > 0 ? std::sqrt(sum / count) : 0;
}

FrameBudget frame_budget(const Work& work, const TrackedFrame& frame, const Settings& settings,
                         int converged_samples, double slack) {
    const Pose pose = true_pose(work, frame.frame);
    const auto truth = truth_of_frame(work, frame.frame, frame.lens);
    const auto photograph = true_photograph(work, frame.frame);
    require(
        truth.has_value() && photograph.has_value(),
        fmt::format("{}: frame {} has no truth; record it with --truth", work.name, frame.frame));
    const TrackedFrame exact = with_true_room(work, frame, pose);
    const Photo photo{encode(*photograph), *photograph};
    const Layers wanted = light_of(work, exact, settings, converged_samples);
    const Layers found = light_of(work, exact, settings);
    const Image<Rgb> reference = composite(photo, wanted, settings.blend).linear;
    const Reference as_reference = make_reference(
        reference, Image<Rgb>(reference.width, reference.height, Rgb(0)), photo.linear);
    FrameBudget budget;
    budget.equation = influenced_rmse(*truth, reference);
    budget.sampling = influenced_rmse(as_reference, composite(photo, found, settings.blend).linear);
    const Layers seen =
        light_of(work, seen_room(work, frame.frame, settings), settings, converged_samples);
    budget.seen = influenced_rmse(*truth, composite(photo, seen, settings.blend).linear);
    budget.displaced_px = displacement_px(work, frame, pose);
    budget.displacement = influenced_rmse(*truth, moved(truth->linear, budget.displaced_px));
    const double reference_mode = std::max(budget.equation, budget.seen);
    budget.total =
        slack * std::sqrt(reference_mode * reference_mode + budget.sampling * budget.sampling +
                          budget.displacement * budget.displacement);
    const IrradianceError light = irradiance_error(found, wanted);
    budget.e_r = light.e_r;
    budget.e_rv = light.e_rv;
    return budget;
}

std::string budget_line(const FrameBudget& b) {
    return fmt::format(
        "allowed {:.4f}: equation {:.4f}, room as seen {:.4f}, samples and filter {:.4f}, "
        "{:.2f} px of pose and depth {:.4f}; E_R {:.3f}, E_RV {:.3f}",
        b.total, b.equation, b.seen, b.sampling, b.displaced_px, b.displacement, b.e_r, b.e_rv);
}

}  // namespace inlay
