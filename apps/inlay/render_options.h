// Options of the commands that simulate light: replay and render.
#pragma once

#include "composite/session/settings.h"

#include "apps/inlay/options.h"
#include <CLI/App.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace inlay {

struct RenderOptions {
    std::string quality = "standard";         // draft, standard or reference
    std::optional<int> samples;               // per pixel in all; none = by quality
    std::string filter, constants, temporal;  // "" = by quality
    std::vector<std::string> set;             // name=value
    bool print_settings = false;
    std::string layers;               // comma-separated names, or all
    std::vector<std::string> assets;  // folders
    bool report = false;              // also a page with times, rays and pictures
};

/// The options refer to `options`, which must outlive the parsing.
void add_render_options(CLI::App& subcommand, RenderOptions& options);

/// `settings`, then the quality's, then single options, then --set, in this order. Throws Error
/// (usage).
Settings settings_from(const RenderOptions& options, const CommonOptions& common,
                       Settings settings = {});

/// Warns, unless both are 0, of samples and pixels that were not finite.
void warn_of_non_finite(std::uint64_t dropped_samples, std::uint64_t replaced_pixels);

/// name=value, one a line, with units as comments.
void print_settings(const Settings& settings);

}  // namespace inlay
