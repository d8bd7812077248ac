// Cell: one method at one setting, with its errors and its price: what the matrix is made of.
#pragma once

#include "composite/accuracy/unit.h"

#include <optional>
#include <string>
#include <vector>

namespace inlay {

/// Over repeats.
struct Spread {
    double median = 0, min = 0, max = 0;
};

/// Of no values: all 0.
Spread spread_of(std::vector<double> values);

/// ms, mean over frames. `total` = trace + filter + composite of each repeat.
struct StageSpreads {
    Spread slam, trace, filter, composite, total;
};

/// Over frames: roots of mean squares for the first three, means for the others.
struct CellError {
    double rmse = 0;
    std::optional<double> rmse_influenced;  // none: no frame has an influenced pixel
    double relative_rmse = 0;
    double psnr = 0, ssim = 1, flip = 0;
};

struct CellFrame {
    int frame = 0;
    std::optional<double> rmse_influenced, truth_rmse_influenced;
    double psnr = 0, flip = 0;  // against `converged`, else against truth
    double ms = 0;              // trace + filter + composite, median over repeats
};

/// A repeat in which the method failed on some frame.
struct FailedRepeat {
    int repeat = 0;  // the first is 0
    std::string message;
};

struct Cell {
    std::string id, knob, value, method;
    bool temporal = false;
    std::optional<double> width;
    int primary = 0, secondary = 0;
    StageSpreads wall, cpu;
    RayCounts rays;  // mean over frames
    double peak_mb = 0;
    std::optional<CellError> converged, truth;
    std::optional<double> flicker;
    std::vector<CellFrame> frames;
    std::string failed;                        // in the first repeat: there are then no figures
    std::vector<FailedRepeat> failed_repeats;  // later ones, which are in no figure
};

/// The cells of one work, in the order of its units: repeats become spreads, and of a method's
/// widths the one with the least error stands (over the influenced pixels, against `converged`,
/// else against truth).
std::vector<Cell> cells_of(const std::vector<UnitRun>& units);

}  // namespace inlay
