#include "composite/write/cache_folder.h"

#include <cstdlib>

namespace inlay {

std::filesystem::path cache_folder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
        return std::filesystem::path(cache) / "inlay";
    if (const char* home = std::getenv("HOME"); home && *home)
        return std::filesystem::path(home) / ".cache" / "inlay";
    return {};
}

}  // namespace inlay
