// RayCounts: how many rays of each class a frame took.
#pragma once

#include <cstdint>

namespace inlay {

/// Shadow rays go towards the environment, indirect ones along the diffuse or glossy lobe; each
/// class counts the queries against one kind of geometry.
struct RayCounts {
    std::uint64_t primary = 0, virtual_shadow = 0, virtual_indirect = 0, real_shadow = 0,
                  real_indirect = 0;

    std::uint64_t total() const {
        return primary + virtual_shadow + virtual_indirect + real_shadow + real_indirect;
    }
    RayCounts& operator+=(const RayCounts& more) {
        primary += more.primary;
        virtual_shadow += more.virtual_shadow;
        virtual_indirect += more.virtual_indirect;
        real_shadow += more.real_shadow;
        real_indirect += more.real_indirect;
        return *this;
    }
};

}  // namespace inlay
