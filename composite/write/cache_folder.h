// Where results are kept that can be made again.
#pragma once

#include <filesystem>

namespace inlay {

/// $XDG_CACHE_HOME/inlay, or ~/.cache/inlay; empty where neither variable is set.
std::filesystem::path cache_folder();

}  // namespace inlay
