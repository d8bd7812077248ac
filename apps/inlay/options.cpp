#include "apps/inlay/options.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "recordings/readers/text_file.h"

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include <vector>

namespace inlay {
namespace {

std::vector<double> numbers_of(const std::string& option, const std::string& text,
                               const std::string& form, std::size_t count) {
    const auto refuse = [&] {
        throw Error(ExitCode::usage, option + ": found '" + text + "', expected " + form);
    };
    std::vector<double> numbers;
    for (const std::string_view word : words(text)) {
        const auto number = parse_number(word);
        if (!number) refuse();
        numbers.push_back(*number);
    }
    if (numbers.size() != count) refuse();
    return numbers;
}

}  // namespace

void add_common_options(CLI::App& subcommand, CommonOptions& options) {
    subcommand.add_option("--frames", options.frames,
                          "The recording's own numbers, as 0-99x2,150 (default: all)");
    subcommand.add_option("--threads", options.threads, "0 = all cores")
        ->check(CLI::Range(0, 4096))
        ->capture_default_str();
    subcommand.add_option("--seed", options.seed, "Of all random numbers")->capture_default_str();
    subcommand.add_flag("--quiet", options.quiet, "Neither progress nor notes");
    subcommand.add_flag("--json", options.json, "A machine-readable result on stdout");
}

void add_recording_options(CLI::App& subcommand, RecordingOptions& options) {
    std::string names;
    for (const std::string& name : reader_names())
        names += (names.empty() ? "" : ", ") + name;
    subcommand.add_option("RECORDING", options.path, "The recording's folder");
    subcommand.add_option("--profile", options.profile,
                          "How to read it: " + names + " (default: found by its files)");
    subcommand.add_option("--depth-scale", options.depth_scale, "Stored units per metre")
        ->check(CLI::PositiveNumber);
    subcommand.add_option("--lens", options.lens, "fx,fy,cx,cy in px");
    subcommand.add_option("--distortion", options.distortion, "k1,k2,p1,p2,k3");
    subcommand
        .add_option("--max-depth", options.max_depth, "m; farther is not measured, 0 = no limit")
        ->check(CLI::NonNegativeNumber);
}

void apply(const CommonOptions& options) {
    set_thread_count(options.threads);
    if (options.quiet) spdlog::set_level(spdlog::level::err);
}

OpenOptions open_options(const RecordingOptions& options) {
    require(!options.path.empty(), "RECORDING is missing: the recording's folder", ExitCode::usage);
    OpenOptions open;
    if (!options.profile.empty()) open.profile = options.profile;
    if (options.depth_scale > 0) open.depth_scale = options.depth_scale;
    if (options.max_depth >= 0) open.max_depth = float(options.max_depth);
    if (!options.lens.empty()) {
        const auto l = numbers_of("--lens", options.lens, "fx,fy,cx,cy", 4);
        open.lens = glm::dvec4(l[0], l[1], l[2], l[3]);
    }
    if (!options.distortion.empty()) {
        const auto d = numbers_of("--distortion", options.distortion, "k1,k2,p1,p2,k3", 5);
        open.distortion = {d[0], d[1], d[2], d[3], d[4]};
    }
    return open;
}

Recording open_and_note(const RecordingOptions& options, const CommonOptions& common) {
    Recording recording = open_recording(options.path, open_options(options));
    if (common.quiet) return recording;
    const RecordingInfo& info = recording.info;
    spdlog::info("{}: {} recording, {} frames", options.path, info.profile, info.frames.size());
    for (const std::string& assumption : info.assumptions)
        spdlog::info("assumed: {}", assumption);
    for (const std::string& warning : info.warnings)
        spdlog::warn("{}", warning);
    return recording;
}

}  // namespace inlay
