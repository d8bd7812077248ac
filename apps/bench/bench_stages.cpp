// What the stages of a real frame cost beside the least that they have to do: bytes gone through
// once, or Embree, a codec or the disk alone. Tracking, sampling and filter have their own
// programs.
//
//   bench_stages [RECORDING FRAME SCENE] [options of Google Benchmark]
#include "composite/session/known_recording.h"
#include "recordings/base/check.h"
#include "recordings/base/keep_memory.h"
#include "slam/mapping/color_camera.h"
#include "slam/mapping/see_model.h"

#include "apps/bench/frame_stages.h"
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <utility>

namespace inlay {
namespace {

namespace fs = std::filesystem;

/// The surface of advance(), but for what is done to its edges and normals.
SurfaceMap seen_surface(const Session& session, const RgbdFrame& frame) {
    const SlamStep view = known_view_of(*session.known, frame);
    const SlamSettings& slam = session.settings.slam;
    if (!color_is_apart(*session.known))
        return see_model(session.known->volume, frame, view.tracking, slam);
    return raycast_volume(session.known->volume, view.surface.lens, view.tracking.world_from_camera,
                          slam.raycast);
}

Subject open_subject(const fs::path& recording, int number, const fs::path& scene) {
    const Settings settings;
    Work work = open_work(recording, settings, scene);
    Session session = start_session(settings, work.scene, work.environment.map,
                                    know_recording(*work.recording, settings));
    RgbdFrame frame = work.recording->load(number);
    OutputFrame out = advance(session, frame, FrameWork::compose);
    require(out.real && out.tracking.status != TrackingStatus::lost,
            "nothing is simulated in this frame; take another");
    SurfaceMap seen = seen_surface(session, frame);
    fs::path folder = fs::temp_directory_path() / ("bench_stages." + std::to_string(getpid()));
    fs::create_directory(folder);
    return {std::move(work), std::move(session), std::move(frame),
            std::move(out),  std::move(seen),    std::move(folder)};
}

std::string on_threads(const std::string& name, int threads) {
    return name + "/" + std::to_string(threads);
}

std::vector<int> thread_counts(const Stage& stage) {
    return stage.serial ? std::vector{1} : std::vector{1, 2};
}

void add_stage(const Stage& stage) {
    for (const int threads : thread_counts(stage)) {
        const std::string name = on_threads(stage.name, threads);
        add_benchmark(name, threads, {}, stage.body);
        for (const Limit& limit : stage.limits)
            add_benchmark(name + "/" + limit.name, threads, limit.amount, limit.body);
    }
}

void print_ratios(const Stage& stage) {
    for (const int threads : thread_counts(stage)) {
        const std::string name = on_threads(stage.name, threads);
        for (const Limit& limit : stage.limits)
            print_ratio(name, name + "/" + limit.name);
    }
    if (!stage.serial) print_ratio(on_threads(stage.name, 1), on_threads(stage.name, 2));
}

int run(int argc, char** argv) {
    keep_freed_memory();
    const std::vector<std::string> words(argv + 1, argv + argc);
    const bool named = words.size() >= 3 && words[0].rfind("--", 0) != 0;
    const Subject subject =
        open_subject(named ? words[0] : INLAY_DEMO_RECORDING, named ? std::stoi(words[1]) : 10,
                     named ? words[2] : INLAY_DEMO_SCENE);
    std::vector<Stage> stages = input_stages(subject);
    for (const Stage& stage : surface_stages(subject))
        stages.push_back(stage);
    for (const Stage& stage : output_stages(subject))
        stages.push_back(stage);
    for (const Stage& stage : stages)
        add_stage(stage);
    std::cout << subject.work.source.string() << ", frame " << subject.frame.index << ", "
              << subject.frame.lens.width << " x " << subject.frame.lens.height << " px\n";

    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    std::cout << "\n";
    for (const Stage& stage : stages)
        print_ratios(stage);
    fs::remove_all(subject.folder);
    return EXIT_SUCCESS;
}

}  // namespace
}  // namespace inlay

int main(int argc, char** argv) { return inlay::run(argc, argv); }
