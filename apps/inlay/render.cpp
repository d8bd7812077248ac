// `inlay render`: one view of a scene, without a recording.
#include "composite/plan/explain.h"
#include "composite/session/named_layers.h"
#include "composite/session/prepare_scene.h"
#include "composite/session/render_view.h"
#include "composite/write/write_exr.h"
#include "composite/write/write_png.h"
#include "recordings/base/check.h"
#include "render/scene/place_object.h"
#include "render/scene/scene_file.h"

#include "apps/inlay/command.h"
#include "apps/inlay/interrupt.h"
#include "apps/inlay/render_options.h"
#include "apps/inlay/replay_output.h"
#include "apps/inlay/run_page.h"
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <iostream>
#include <memory>

namespace inlay {
namespace {

struct RenderCommandOptions {
    CommonOptions common;
    RenderOptions render;
    std::string scene, out;
    double time = 0;          // s
    int photo_samples = 256;  // per pixel
    bool explain = false;
};

VirtualScene scene_of(const SceneFile& file, const std::string& name) {
    const auto no_surface = [&](int) -> SurfaceMap {
        throw Error(ExitCode::bad_data, name +
                                            ": 'place' needs a recording; `render` has none: give "
                                            "the object a 'transform'");
    };
    return resolve_placements(file, no_surface, file.view->up);
}

void require_picture_name(const std::string& out) {
    const std::filesystem::path extension = std::filesystem::path(out).extension();
    require(extension == ".exr" || extension == ".png",
            "--out " + out + ": expected a name in .exr or .png", ExitCode::usage);
}

void write_result(const RenderCommandOptions& o, const OutputFrame& out,
                  const std::vector<std::string>& layers) {
    const std::filesystem::path file = o.out;
    if (file.extension() == ".png") {
        write_png(file, out.composite.display);
        return;
    }
    const NamedLayers named = named_layers(out, layers);
    ExrFile exr;
    exr.picture = &out.composite.linear;
    exr.layers = named.layers;
    write_exr(file, exr);
}

/// Of the picture, under its name with the ending .html.
void write_report(const RenderCommandOptions& o, const Settings& settings, const OutputFrame& out) {
    const std::filesystem::path scene = std::filesystem::path(o.scene).filename();
    FrameReport frame = report_of(0, o.time, out);
    frame.tracking = TrackingStatus::tracked;  // the scene says from where it is seen
    const StageTimes& ms = frame.ms;
    frame.ms.total = ms.plan + ms.trace + ms.filter + ms.composite;
    write_run_page(std::filesystem::path(o.out).replace_extension(".html"),
                   {"the view of " + scene.stem().string(),
                    scene.string(),
                    settings,
                    out.plan,
                    {frame},
                    {{0, encode(out.camera), out.composite.display}},
                    "render"});
}

void print_totals(const RenderCommandOptions& o, const OutputFrame& out) {
    const RayCounts& r = out.rays;
    const std::uint64_t rays =
        r.primary + r.virtual_shadow + r.virtual_indirect + r.real_shadow + r.real_indirect;
    if (o.common.json) {
        const nlohmann::ordered_json json{{"out", o.out},
                                          {"rays", rays},
                                          {"dropped_samples", out.dropped_samples},
                                          {"replaced_pixels", out.composite.replaced_pixels},
                                          {"ms",
                                           {{"trace", out.ms.trace},
                                            {"filter", out.ms.filter},
                                            {"composite", out.ms.composite}}}};
        std::cout << json.dump(2) << "\n";
        return;
    }
    spdlog::info("{}: trace {:.0f} ms, filter {:.0f} ms, {} rays", o.out, out.ms.trace,
                 out.ms.filter, rays);
    warn_of_non_finite(out.dropped_samples, out.composite.replaced_pixels);
}

int run(const RenderCommandOptions& o) {
    apply(o.common);
    const Settings settings = settings_from(o.render, o.common);
    if (o.render.print_settings) {
        print_settings(settings);
        return 0;
    }
    const std::vector<std::string> layers = parse_layers(o.render.layers);
    require(!o.scene.empty(), "render: SCENE is missing: a scene file with a 'view'",
            ExitCode::usage);
    if (!o.explain) require_picture_name(o.out);
    const SceneFile file =
        load_scene_file(o.scene, {o.render.assets.begin(), o.render.assets.end()},
                        o.explain ? SceneUse::explain : SceneUse::simulate);
    for (const std::string& warning : file.warnings)
        spdlog::warn("{}", warning);
    require(file.view.has_value(),
            o.scene + ": `render` needs to know from where the scene is seen: add a 'view'");
    const VirtualScene scene = scene_of(file, o.scene);
    const LoadedEnvironment light = load_environment(file.environment, file.view->up, {0, 0, 1});
    if (light.replaced_texels > 0) spdlog::warn("{}", replaced_texels_text(light));
    const EnvironmentSampler environment = make_environment_sampler(light.map);
    const SceneView view{scene, environment, file.view->lens, file.view->world_from_camera, o.time};
    if (o.explain) {
        SceneFacts facts = facts_of_view(view);
        facts.requests = file.requests;
        std::cout << explain(plan_effects(facts, settings.trace, settings.filter));
        return 0;
    }
    catch_interrupts();
    const OutputFrame out = render_view(view, settings, o.photo_samples, interrupted);
    write_result(o, out, layers);
    if (o.render.report) write_report(o, settings, out);
    print_totals(o, out);
    return 0;
}

}  // namespace

std::function<int()> add_render(CLI::App& subcommand) {
    const auto o = std::make_shared<RenderCommandOptions>();
    subcommand.add_option("SCENE", o->scene, "the scene file, with a 'view'");
    subcommand.add_option("--out", o->out, "the picture to write, .exr or .png");
    subcommand.add_option("--time", o->time, "s, for objects that move")->capture_default_str();
    subcommand
        .add_option("--photo-samples", o->photo_samples,
                    "paths per pixel of the picture that stands for the photograph")
        ->check(CLI::Range(2, 1 << 20))
        ->capture_default_str();
    subcommand.add_flag("--explain", o->explain,
                        "print which effects are simulated and why, and stop");
    add_common_options(subcommand, o->common);
    add_render_options(subcommand, o->render);
    return [o] { return run(*o); };
}

}  // namespace inlay
