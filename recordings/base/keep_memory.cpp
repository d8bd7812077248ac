#include "recordings/base/keep_memory.h"

#include <cstdlib>  // tells which C library this is

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace inlay {

void keep_freed_memory() {
#if defined(__GLIBC__)
    constexpr int largest_image = 1 << 25;  // bytes; glibc takes no larger one
    constexpr int kept = 1 << 30;           // bytes, at the end of the heap
    mallopt(M_MMAP_THRESHOLD, largest_image);
    mallopt(M_TRIM_THRESHOLD, kept);
#endif
}

}  // namespace inlay
