// The page of one run, replayed or rendered: times, rays, pixels, plan, settings, a few pictures.
#pragma once

#include "composite/plan/effect_plan.h"
#include "composite/session/settings.h"
#include "composite/write/frame_report.h"
#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <filesystem>
#include <string>
#include <vector>

namespace inlay {

/// One frame before and after, of one size.
struct PicturePair {
    int frame = 0;
    Image<EncodedRgb> photograph, composite;
};

struct RunPage {
    std::string recording, scene;  // names
    Settings settings;
    EffectPlan plan;
    std::vector<FrameReport> frames;  // ascending
    std::vector<PicturePair> pictures;
    std::string command = "replay";  // or render
};

/// Four times the distance of each channel's code values, at most 255.
Image<EncodedRgb> enlarged_difference(const Image<EncodedRgb>& a, const Image<EncodedRgb>& b);

/// Writes the page, one HTML file that loads nothing, with the machine and the time of writing.
/// Throws Error (cannot_create, disk_fault).
void write_run_page(const std::filesystem::path& file, const RunPage& page);

}  // namespace inlay
