// What sampling a real frame costs beside what Embree alone needs for rays: the thesis's, traced as
// two full scenes, and exactly those that the sampler traced.
//
//   bench_frame [RECORDING FRAME SCENE] [options of Google Benchmark]
#include "composite/accuracy/unit.h"
#include "recordings/base/keep_memory.h"
#include "recordings/base/parallel.h"

#include "apps/bench/bare_embree.h"
#include "apps/bench/best_times.h"
#include "apps/bench/thesis_rays.h"
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace inlay {
namespace {

constexpr int repeats = 5;

/// One frame of a recording, tracked, with its objects in place.
struct Subject {
    Settings settings;
    Work work;
    TrackedFrame frame;
    EmbreeScene objects;

    SamplingSettings sampling(Estimator estimator) const {
        SamplingSettings result = settings.trace;
        result.depth_tolerance = frame.depth_tolerance;
        result.estimator = estimator;
        return result;
    }
    /// `light`: what is known of E_R; null: it is sampled afresh.
    TwoModeResult sample(const SamplingSettings& sampling, ModelLight* light = nullptr) const {
        return sample_two_modes(
            {frame.lens, frame.world_from_camera, frame.geometry, objects, work.environment, light},
            sampling, std::uint32_t(frame.frame));
    }
    std::unique_ptr<ModelLight> model_light(const SamplingSettings& sampling) const {
        return make_model_light(frame.room->mesh, work.environment, sampling,
                                frame.geometry.offset);
    }
};

/// As many samples on virtual surfaces as on real ones, as the thesis has.
SamplingSettings one_for_one(SamplingSettings sampling) {
    sampling.coverage = 0;
    sampling.virtual_repeats = 1;
    return sampling;
}

Subject open_subject(const std::filesystem::path& recording, int frame,
                     const std::filesystem::path& scene, RealGeometryKind kind) {
    Settings settings;
    settings.geometry.kind = kind;
    Work work = open_work(recording, settings, scene);
    TrackedFrame tracked = track_frames(work, {frame}, settings).at(0);
    EmbreeScene objects = EmbreeSceneCache().place(work.scene, tracked.time, /*real=*/false);
    return {settings, std::move(work), std::move(tracked), std::move(objects)};
}

/// The rays that the sampler sends for the subject's frame, against each kind of geometry.
struct OwnRays {
    BareRays on_virtual, on_real;
};

OwnRays own_rays(Subject& subject, const SamplingSettings& sampling, ModelLight* light) {
    set_thread_count(1);  // a log is for one thread
    RayLog on_virtual, on_real;
    subject.objects.log_to(&on_virtual);
    const RealGeometry plain = subject.frame.geometry;
    RealGeometry& logged = subject.frame.geometry;
    logged.distances = [&](const RayPacket& rays) {
        on_real.queries.push_back({rays, true});
        return plain.distances(rays);
    };
    logged.occluded = [&](const RayPacket& rays) {
        on_real.queries.push_back({rays, false});
        return plain.occluded(rays);
    };
    logged.radiances = [&](const RayPacket& rays, const SampleKeys& keys) {
        on_real.queries.push_back({rays, true});
        return plain.radiances(rays, keys);
    };
    subject.sample(sampling, light);
    subject.frame.geometry = plain;
    subject.objects.log_to(nullptr);
    return {bare_rays(on_virtual), bare_rays(on_real)};
}

Amount rays_of(const BareRays& a, const BareRays& b) { return {"rays", double(a.rays + b.rays)}; }

/// The sampler, and Embree alone with the same rays. `light` is known before.
void add_sampler(const std::string& name, Subject& subject, const SamplingSettings& sampling,
                 const BareScene& on_real, const BareScene& on_virtual,
                 const std::shared_ptr<ModelLight>& light = nullptr) {
    if (light) subject.sample(sampling, light.get());
    const auto rays = std::make_shared<const OwnRays>(own_rays(subject, sampling, light.get()));
    const Amount count = rays_of(rays->on_real, rays->on_virtual);
    const auto sample = [&subject, sampling, light] {
        benchmark::DoNotOptimize(subject.sample(sampling, light.get()));
    };
    const auto trace = [rays, &on_real, &on_virtual] {
        benchmark::DoNotOptimize(trace_bare(on_real, rays->on_real));
        benchmark::DoNotOptimize(trace_bare(on_virtual, rays->on_virtual));
    };
    add_benchmark(name, 2, count, sample, repeats);
    add_benchmark(name + "/1 thread", 1, count, sample, repeats);
    add_benchmark(name + "/its rays alone", 2, count, trace, repeats);
}

int run(int argc, char** argv) {
    keep_freed_memory();
    std::vector<std::string> words(argv + 1, argv + argc);
    const bool named = words.size() >= 3 && words[0].rfind("--", 0) != 0;
    const std::filesystem::path recording = named ? words[0] : INLAY_DEMO_RECORDING;
    const int number = named ? std::stoi(words[1]) : 10;
    const std::filesystem::path scene = named ? words[2] : INLAY_DEMO_SCENE;
    Subject subject = open_subject(recording, number, scene, RealGeometryKind::model);
    Subject marched = open_subject(recording, number, scene, RealGeometryKind::screen);
    std::cout << recording.string() << ", frame " << number << ", " << subject.frame.lens.width
              << " x " << subject.frame.lens.height << " px\n";

    const EmbreeScene& room = *subject.frame.room->mesh;
    const BareScene real({&room}), objects({&subject.objects}), all({&room, &subject.objects});
    const auto in_real =
        std::make_shared<const BareRays>(thesis_rays(subject.work, subject.frame, nullptr, real));
    const auto in_all = std::make_shared<const BareRays>(
        thesis_rays(subject.work, subject.frame, &subject.objects, all));
    const auto trace_two_scenes = [&, in_real, in_all] {
        benchmark::DoNotOptimize(trace_bare(real, *in_real));
        benchmark::DoNotOptimize(trace_bare(all, *in_all));
    };
    add_benchmark("two scenes", 2, rays_of(*in_real, *in_all), trace_two_scenes, repeats);
    add_sampler("two modes", subject, one_for_one(subject.sampling(Estimator::two_mode)), real,
                objects);
    const SamplingSettings difference = subject.sampling(Estimator::difference);
    add_sampler("difference", subject, difference, real, objects);
    add_sampler("difference, E_R kept", subject, difference, real, objects,
                subject.model_light(difference));
    add_sampler("difference, one for one, E_R kept", subject, one_for_one(difference), real,
                objects, subject.model_light(difference));
    const auto march = [&marched] {
        benchmark::DoNotOptimize(marched.sample(marched.sampling(Estimator::difference)));
    };
    add_benchmark("difference on screen", 2, {}, march, repeats);

    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    std::cout << "\n";
    for (const std::string name :
         {"two modes", "difference", "difference, E_R kept", "difference, one for one, E_R kept"}) {
        print_ratio(name, "two scenes");
        print_ratio(name, name + "/its rays alone");
        print_ratio(name + "/1 thread", name);
    }
    return EXIT_SUCCESS;
}

}  // namespace
}  // namespace inlay

int main(int argc, char** argv) { return inlay::run(argc, argv); }
