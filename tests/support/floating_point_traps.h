// FloatingPointTraps: invalid operations, divisions by zero and overflows become signals.
#pragma once

#include <cfenv>

namespace inlay::test {

/// Traps on the calling thread for as long as it lives, then restores what was before; parallel
/// loops are under them after set_thread_count(1). Keep calls into other libraries out of its
/// scope: they may compute with lanes that nobody reads.
class FloatingPointTraps {
public:
    FloatingPointTraps() {
        std::feclearexcept(FE_ALL_EXCEPT);
        before_ = feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
    }
    ~FloatingPointTraps() {
        fedisableexcept(FE_ALL_EXCEPT);
        std::feclearexcept(FE_ALL_EXCEPT);
        feenableexcept(before_);
    }
    FloatingPointTraps(const FloatingPointTraps&) = delete;
    FloatingPointTraps& operator=(const FloatingPointTraps&) = delete;

private:
    int before_ = 0;
};

}  // namespace inlay::test
