// `inlay accuracy`: what accuracy costs in time.
#include "composite/accuracy/accuracy_json.h"
#include "composite/accuracy/bench.h"
#include "composite/accuracy/built_in_works.h"
#include "composite/accuracy/judged_frames.h"
#include "composite/accuracy/summary.h"
#include "composite/write/atomic_file.h"
#include "recordings/base/check.h"

#include "apps/inlay/command.h"
#include "apps/inlay/frame_list.h"
#include "apps/inlay/interrupt.h"
#include "apps/inlay/options.h"
#include "apps/inlay/progress.h"
#include "apps/report/report_page.h"
#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>

namespace inlay {
namespace {

namespace fs = std::filesystem;

struct AccuracyOptions {
    CommonOptions common;
    std::vector<std::string> works;
    std::string out, scene;
    std::vector<std::string> only, settings;
    int repeat = 0;             // 0: 3, or 1 with --quick
    int reference_samples = 0;  // 0: 2048, or 512 with --quick
    bool quick = false, resume = false, blame_only = false;
};

BenchOptions bench_options(const AccuracyOptions& o) {
    BenchOptions bench;
    bench.settings.trace.seed = o.common.seed;
    for (const std::string& assignment : o.settings)
        apply_setting(bench.settings, assignment);
    bench.quick = o.quick;
    bench.repeats = o.repeat != 0 ? o.repeat : (o.quick ? 1 : 3);
    bench.only = o.only;
    if (!o.common.frames.empty()) {
        const FrameList list = parse_frames(o.common.frames);
        bench.wanted_frame = [list](int frame) { return list.contains(frame); };
    }
    bench.converged_samples =
        o.reference_samples != 0 ? o.reference_samples : (o.quick ? 512 : 2048);
    bench.resume = o.resume;
    bench.program = INLAY_VERSION;
    return bench;
}

/// Frames that a run names have truth.
BuiltInSettings built_in_settings(const AccuracyOptions& o) {
    BuiltInSettings built_in;
    if (o.quick) built_in.truth_samples = 256;
    if (o.common.frames.empty()) return built_in;
    const FrameList wanted = parse_frames(o.common.frames);
    built_in.truth_frames.clear();
    for (int frame = 0; frame < built_in.frames; ++frame)
        if (wanted.contains(frame)) built_in.truth_frames.push_back(frame);
    require(!built_in.truth_frames.empty(),
            "accuracy: none of the frames " + o.common.frames + " is in 0-" +
                std::to_string(built_in.frames - 1),
            ExitCode::usage);
    return built_in;
}

/// The named works, or the built-in ones, which are recorded in `folder`.
std::vector<Work> open_works(const AccuracyOptions& o, const Settings& settings,
                             const fs::path& folder) {
    std::vector<Work> works;
    for (const std::string& path : o.works)
        works.push_back(open_work(path, settings, o.scene));
    if (!o.works.empty()) return works;
    const BuiltInSettings built_in = built_in_settings(o);
    for (const std::string& name : built_in_names()) {
        Progress progress("recording " + name + ", frames", built_in.frames, o.common.quiet);
        works.push_back(built_in_work(name, INLAY_SCENES_DIR, folder, built_in,
                                      {[&](int done) { progress.advance_to(done); }, interrupted}));
    }
    return works;
}

/// Calls `found` with each frame's blame as soon as it is known.
std::vector<FrameBlame> blame_frames(const Work& work, const BenchOptions& options,
                                     const std::function<void(const FrameBlame&)>& found) {
    require(!work.truth_frames.empty(),
            work.source.string() +
                ": has no truth, so no stage can be blamed; record it with "
                "`inlay record --truth`");
    const auto every = [](int) { return true; };
    std::vector<FrameBlame> frames;
    for (const int frame :
         measured_frames(work, options.wanted_frame ? options.wanted_frame : every)) {
        if (interrupted())
            throw Error(ExitCode::interrupted, "accuracy: interrupted between two frames");
        frames.push_back(
            blame_frame(work, frame, options.settings, std::max(1, options.converged_samples / 2)));
        found(frames.back());
    }
    return frames;
}

void print_blame(const std::vector<Work>& works, const BenchOptions& options, bool as_json) {
    if (!as_json) std::cout << blame_table_head();
    std::vector<WorkBlame> blames;
    for (const Work& work : works)
        blames.push_back({work.name, blame_frames(work, options, [&](const FrameBlame& blame) {
                              if (!as_json)
                                  std::cout << blame_table_row(work.name, blame) << std::flush;
                          })});
    if (as_json) std::cout << to_json_text(blames);
}

/// A folder that goes when its owner does.
class TemporaryFolder {
public:
    TemporaryFolder()
        : path(fs::temp_directory_path() / ("inlay-accuracy-" + std::to_string(::getpid()))) {
        make_folder(path);
    }
    ~TemporaryFolder() {
        std::error_code ignored;  // what cannot be removed stays
        fs::remove_all(path, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const fs::path path;
};

void warn_of(const std::vector<Work>& works) {
    for (const Work& work : works)
        for (const std::string& warning : work.warnings)
            spdlog::warn("{}: {}", work.name, warning);
}

/// The built-in works need a folder: that of the results, or one that does not stay.
int blame_alone(const AccuracyOptions& o, const BenchOptions& options) {
    std::optional<TemporaryFolder> temporary;
    fs::path folder = fs::path(o.out) / "works";
    if (o.out.empty() && o.works.empty()) folder = temporary.emplace().path;
    const std::vector<Work> works = open_works(o, options.settings, folder);
    warn_of(works);
    print_blame(works, options, o.common.json);
    return 0;
}

void print_summary(const AccuracyReport& report) {
    for (const WorkReport& work : report.works) {
        for (const EqualError& e : price_list(work.cells).equal_error)
            spdlog::info(
                "{}: {}{} with 16 samples: RMSE {:.4f} in {:.0f} ms; unfiltered takes "
                "{}{:.1f} times as long",
                work.name, e.method, e.temporal ? " with the previous frame" : "", e.error,
                e.filtered_ms, e.beyond ? "more than " : "", e.speed_up);
        for (const FrameVerdict& verdict : work.verdicts)
            spdlog::info("{}, {}", work.name, verdict_line(verdict));
        for (const FrameBlame& blame : work.blame)
            spdlog::info("{}, {}", work.name, blame_line(blame));
    }
}

int measure(const AccuracyOptions& o, const std::vector<Work>& works, const BenchOptions& options) {
    const fs::path folder = o.out;
    std::optional<Progress> progress;
    const BenchWatcher watcher{[&](int done, int of) {
                                   if (!progress)
                                       progress.emplace("measurements", of, o.common.quiet);
                                   progress->advance_to(done);
                               },
                               [](const std::string& warning) { spdlog::warn("{}", warning); },
                               interrupted};
    const BenchResult result = run_bench(works, options, folder, watcher);
    if (!result.complete) {
        spdlog::warn("interrupted; what was measured stays, go on with --resume");
        return int(ExitCode::interrupted);
    }
    const std::string json = to_json_text(result.report);
    write_text(folder / "accuracy.json", json);
    write_text(folder / "accuracy.html", report_page(json));
    write_text(folder / "summary.md", summary_text(result.report));
    if (o.common.json)
        std::cout << json;
    else
        print_summary(result.report);
    return 0;
}

int run(const AccuracyOptions& o) {
    apply(o.common);
    const BenchOptions options = bench_options(o);
    validate(options);
    require(o.blame_only || !o.out.empty(), "accuracy: --out is missing: the folder to write",
            ExitCode::usage);
    catch_interrupts();
    if (o.blame_only) return blame_alone(o, options);
    make_folder(o.out);
    const std::vector<Work> works = open_works(o, options.settings, fs::path(o.out) / "works");
    warn_of(works);
    return measure(o, works, options);
}

}  // namespace

std::function<int()> add_accuracy(CLI::App& subcommand) {
    const auto o = std::make_shared<AccuracyOptions>();
    o->common.frames.clear();  // the first and the last frame with truth
    subcommand.add_option("WORK", o->works,
                          "recordings with truth, or scenes with a view (default: the built-in "
                          "recordings)");
    subcommand.add_option("--out", o->out, "the folder to write");
    subcommand.add_option("--scene", o->scene,
                          "the scene of a recording that has no scene.json of its own");
    subcommand.add_option("--only", o->only, "names of methods and knobs to measure")
        ->allow_extra_args(false);
    subcommand.add_option("--repeat", o->repeat, "of every time (default: 3; 1 with --quick)");
    subcommand.add_option("--reference-samples", o->reference_samples,
                          "per pixel of the converged reference (default: 2048; 512 with --quick)");
    subcommand.add_option("--set", o->settings, "name=value, see replay --print-settings")
        ->allow_extra_args(false);
    subcommand.add_flag("--quick", o->quick, "few samples, few knobs, one repeat");
    subcommand.add_flag("--resume", o->resume, "go on with the run that the folder holds");
    subcommand.add_flag(
        "--blame", o->blame_only,
        "print which stage each frame's error comes from, and stop; needs no --out");
    add_common_options(subcommand, o->common);
    return [o] { return run(*o); };
}

}  // namespace inlay
