#include "apps/bench/frame_stages.h"

#include "composite/write/write_exr.h"
#include "composite/write/write_png.h"
#include "render/filter/environment_bandwidth.h"
#include "render/sample/light_nets.h"

#include "apps/bench/stage_limits.h"
#include <benchmark/benchmark.h>

#include <cstddef>
#include <memory>

namespace inlay {
namespace {

namespace fs = std::filesystem;

Stage loading(const Subject& s) {
    const auto load = [&s] { benchmark::DoNotOptimize(s.work.recording->load(s.frame.index)); };
    Stage stage{.name = "load", .body = load, .limits = {}, .serial = true};
    const std::vector<fs::path> files = picture_files(s.work.source, s.frame.index);
    if (files.size() != 2) return stage;  // color and depth: else they are named otherwise
    const auto bytes = read_files(files);
    const Amount size{"bytes", double(bytes[0].size() + bytes[1].size())};
    const auto read = [files] { benchmark::DoNotOptimize(read_files(files)); };
    stage.limits = {{"imdecode alone", size, [bytes] { decode_pictures(bytes); }},
                    {"reading alone", size, read}};
    return stage;
}

Stage planning(const Subject& s) {
    const auto plan = [&s] {
        SlamStep view;
        view.surface.lens = s.out.real->surface->lens;
        view.tracking = s.out.tracking;
        view.gain = s.out.exposure;
        const SceneFacts facts =
            gather_facts(in_frame(s.session, view, s.frame.time, s.frame.time));
        benchmark::DoNotOptimize(plan_effects(facts, s.settings().trace, s.settings().filter));
    };
    return {.name = "plan", .body = plan, .limits = {}, .serial = true};
}

Stage bandwidth(const Subject& s) {
    Traffic texels;
    texels.reads(s.environment().radiance);
    const auto find = [&s] {
        benchmark::DoNotOptimize(environment_bandwidth(s.environment().radiance));
    };
    return {"bandwidth of environment", find, {bytes_once(texels)}, /*serial=*/true};
}

/// With the copy of the map that the sampler keeps.
Stage light_tables(const Subject& s) {
    Traffic texels;
    texels.reads(s.environment().radiance), texels.writes(s.environment().radiance);
    const auto make = [&s] { benchmark::DoNotOptimize(make_environment_sampler(s.environment())); };
    return {"tables of environment", make, {bytes_once(texels)}, /*serial=*/true};
}

Stage light_nets(const Subject& s) {
    const SamplingSettings& sampling = s.settings().trace;
    const int wanted = sampling.primary * sampling.secondary * sampling.virtual_repeats;
    const auto make = [&s, wanted] { return make_light_nets(s.session.environment, wanted, {}); };
    const int count = int(make().samples.size());
    const auto draw = [&s, count] { draw_samples(s.session.environment, count); };
    return {"light nets",
            [make] { benchmark::DoNotOptimize(make()); },
            {{"as many plain samples", {"samples", double(count)}, draw}}};
}

Stage linearising(const Subject& s) {
    Traffic traffic;
    traffic.reads(s.frame.color), traffic.writes(s.frame.color), traffic.writes(s.out.camera);
    const auto linear = [&s] {
        benchmark::DoNotOptimize(linearise(s.frame.color, s.out.exposure));
    };
    return {"linearise", linear, {bytes_once(traffic)}};
}

Stage compositing(const Subject& s) {
    const Layers& layers = s.out.layers;
    Traffic traffic;
    traffic.reads(s.frame.color), traffic.reads(s.out.camera);
    traffic.reads(layers.m), traffic.reads(layers.k_v), traffic.reads(layers.s_rv);
    for (const Irradiance* e : {&layers.direct, &layers.indirect})
        traffic.reads(e->e_r), traffic.reads(e->e_rv_real), traffic.reads(e->e_rv_virtual);
    traffic.writes(s.out.composite.display), traffic.writes(s.out.composite.linear);
    const auto photo = std::make_shared<const Photo>(linearise(s.frame.color, s.out.exposure));
    const auto blend = [&s, photo] {
        benchmark::DoNotOptimize(composite(*photo, s.out.layers, s.settings().blend));
    };
    return {"composite", blend, {bytes_once(traffic)}};
}

/// The disk alone, and the codec alone.
template <class Encode>
std::vector<Limit> writing_limits(const Subject& s, const Encode& encode) {
    const std::vector<std::byte> bytes = encode();
    const Amount amount{"bytes", double(bytes.size())};
    const auto write = [file = s.folder / "plain", bytes] { write_plainly(file, bytes); };
    return {{"plain write and sync", amount, write},
            {"encoding alone", amount, [encode] { benchmark::DoNotOptimize(encode()); }}};
}

Stage writing_png(const Subject& s) {
    const Image<EncodedRgb>& picture = s.out.composite.display;
    const auto encode = [&picture] { return encode_png(picture); };
    return {.name = "write PNG",
            .body = [&picture, file = s.folder / "picture.png"] { write_png(file, picture); },
            .limits = writing_limits(s, encode),
            .serial = true};
}

Stage writing_exr(const Subject& s) {
    ExrFile exr;
    exr.picture = &s.out.composite.linear;
    const auto encode = [exr] { return encode_exr(exr); };
    return {.name = "write EXR",
            .body = [exr, file = s.folder / "picture.exr"] { write_exr(file, exr); },
            .limits = writing_limits(s, encode),
            .serial = true};
}

}  // namespace

Limit bytes_once(const Traffic& traffic) {
    return {"its bytes once", {"bytes", bytes_of(traffic)}, streaming(traffic)};
}

std::vector<Stage> input_stages(const Subject& subject) {
    return {loading(subject), planning(subject), bandwidth(subject), light_tables(subject),
            light_nets(subject)};
}

std::vector<Stage> output_stages(const Subject& subject) {
    return {linearising(subject), compositing(subject), writing_png(subject), writing_exr(subject)};
}

}  // namespace inlay
