// accuracy.json: the price list as a file; its schema stands in README.md beside this.
#pragma once

#include "composite/accuracy/blame.h"
#include "composite/accuracy/cell.h"
#include "composite/accuracy/error_estimate.h"
#include "composite/accuracy/frame_verdict.h"
#include "composite/accuracy/machine.h"
#include "composite/accuracy/price_list.h"
#include "composite/accuracy/work.h"

#include <string>
#include <vector>

namespace inlay {

/// A picture for the page: what `inlay accuracy` shows beside the figures.
struct ReportPicture {
    std::string cell;  // id, or truth, photograph, converged
    std::string title;
    int frame = 0;
    std::string png;  // data URL
};

struct WorkReport {
    std::string name, kind;
    int width = 0, height = 0;
    std::vector<int> frames;
    double environment_bandwidth = 0;  // 1/rad
    int converged_samples = 0, truth_samples = 0;
    double converged_standard_error = 0, truth_standard_error = 0;
    std::vector<Cell> cells;
    std::vector<ReportPicture> pictures;
    std::vector<FrameBlame> blame;
    std::vector<FrameVerdict> verdicts;  // of the frames with truth and virtual objects in view
    std::optional<EstimateQuality> estimate;
};

struct AccuracyReport {
    std::string program, date;
    Machine machine;
    Settings settings;
    int repeats = 0;
    std::uint32_t seed = 1;
    bool quick = false;
    std::vector<WorkReport> works;
};

std::string to_json_text(const AccuracyReport& report);

/// Of a work, by its name.
struct WorkBlame {
    std::string work;
    std::vector<FrameBlame> frames;
};

/// The blame tables alone: {"version", "kind": "blame", "works": [{"name", "blame"}]}, where blame
/// is as in accuracy.json.
std::string to_json_text(const std::vector<WorkBlame>& works);

}  // namespace inlay
