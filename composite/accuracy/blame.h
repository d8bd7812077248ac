// Blame: which stage of the loop a composite's error comes from, by putting the truth in place of
// one stage at a time.
#pragma once

#include "composite/accuracy/unit.h"

#include <optional>
#include <string>
#include <vector>

namespace inlay {

enum class Stage { poses, geometry, sampling, filter, composite };
inline constexpr Stage all_stages[] = {Stage::poses, Stage::geometry, Stage::sampling,
                                       Stage::filter, Stage::composite};
const char* name_of(Stage stage);

/// RMSE against truth, relative radiance over the influenced pixels, of one frame.
struct StageBlame {
    Stage stage = Stage::poses;
    double swapped_rmse = 0;  // with this stage's truth, all others as they are
    double share = 0;         // of the mean square that goes away with it; may be negative
};

struct FrameBlame {
    int frame = 0;
    double rmse = 0;       // as it is
    double best_rmse = 0;  // with the truth in place of all stages: what eq. 6.2 itself leaves
    double photograph_rmse = 0;  // of the recorded picture, without any object
    std::vector<StageBlame> stages;
    Stage culprit = Stage::composite;  // the largest share; composite where all leave most of it
};

/// What stands in for each stage:
/// poses: the recorded ones; geometry: the exact room of the scene, its radiance included, seen
/// from the pose that was found; sampling: `converged_samples` per pixel under the widths of the
/// setting's own count; filter: none, with `converged_samples` per pixel; composite: the recorded
/// picture before noise and 8-bit code values. Throws Error where the work has no truth, or no
/// room.
FrameBlame blame_frame(const Work& work, int frame, const Settings& settings,
                       int converged_samples);

/// One line: the frame, the stage, and the figures.
std::string blame_line(const FrameBlame& blame);

}  // namespace inlay
