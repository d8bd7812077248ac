#include "apps/inlay/render_options.h"

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include <iostream>

namespace inlay {
namespace {

void apply_quality(Settings& settings, const std::string& quality) {
    if (quality == "draft") settings.trace = with_samples(settings.trace, 4);
    if (quality == "reference") {
        settings.trace = with_samples(settings.trace, 1024);
        settings.filter.enabled = false;
    }
}

}  // namespace

void add_render_options(CLI::App& subcommand, RenderOptions& o) {
    subcommand
        .add_option("--quality", o.quality,
                    "draft: 4 samples; standard: 16; reference: 1024, unfiltered")
        ->check(CLI::IsMember({"draft", "standard", "reference"}))
        ->capture_default_str();
    subcommand.add_option(
        "--samples", o.samples,
        "light samples per pixel of a real surface: 4 primary x N/4 secondary (below 4: "
        "N x 1); virtual ones get more, see trace.virtual_repeats and trace.coverage");
    subcommand.add_option("--filter", o.filter, "the axis-aligned filter")
        ->check(CLI::IsMember(setting_words("filter.enabled")));
    subcommand.add_option("--constants", o.constants, "of the filter")
        ->check(CLI::IsMember(setting_words("filter.constants")));
    subcommand.add_option("--temporal", o.temporal, "filter with the frame before")
        ->check(CLI::IsMember(setting_words("filter.temporal")));
    subcommand.add_option("--set", o.set, "name=value of any setting; may be given several times")
        ->allow_extra_args(false);
    subcommand.add_flag("--print-settings", o.print_settings, "list every setting and stop");
    subcommand.add_option("--layers", o.layers, "layers of the EXR files: names, or all");
    subcommand.add_flag("--report", o.report,
                        "also write a page of times, rays, plan and pictures: report.html, or of "
                        "one picture the page beside it");
    subcommand
        .add_option("--assets", o.assets, "folder with files of the scene; several are possible")
        ->allow_extra_args(false);
}

Settings settings_from(const RenderOptions& o, const CommonOptions& common, Settings settings) {
    settings.trace.seed = common.seed;
    apply_quality(settings, o.quality);
    if (o.samples) settings.trace = with_samples(settings.trace, *o.samples);
    const auto set = [&](const char* name, const std::string& value) {
        if (!value.empty()) apply_setting(settings, name + ("=" + value));
    };
    set("filter.enabled", o.filter);
    set("filter.constants", o.constants);
    set("filter.temporal", o.temporal);
    for (const std::string& assignment : o.set)
        apply_setting(settings, assignment);
    validate(settings);
    return settings;
}

void warn_of_non_finite(std::uint64_t dropped_samples, std::uint64_t replaced_pixels) {
    if (dropped_samples > 0)
        spdlog::warn("{} samples were not finite and were left out", dropped_samples);
    if (replaced_pixels > 0)
        spdlog::warn("{} pixels were not finite and show the photograph", replaced_pixels);
}

void print_settings(const Settings& settings) {
    for (const SettingRow& row : setting_rows())
        std::cout << row.name << "=" << row.get(settings)
                  << (row.unit.empty() ? "" : "  # " + row.unit) << "\n";
}

}  // namespace inlay
