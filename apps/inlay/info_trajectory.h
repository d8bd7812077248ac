// `inlay info --trajectory A B`: how far one trajectory is from another.
#pragma once

#include <filesystem>

namespace inlay {

/// Prints the absolute and relative error (Sturm et al. 2012) of the poses in `estimated` against
/// those in `reference`, TUM files both: each pose with the reference pose next to it in time,
/// within 20 ms, as the data set's own tools pair them. Throws Error: as read_tum_trajectory, and
/// bad_data where fewer than two poses pair.
void print_trajectory_errors(const std::filesystem::path& estimated,
                             const std::filesystem::path& reference, bool as_json);

}  // namespace inlay
