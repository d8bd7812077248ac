// FloatingPointTraps: invalid operations, divisions by zero and overflows end the program.
#pragma once

#include <cfenv>

namespace inlay::test {

/// Traps on the calling thread for as long as it lives, then restores what was before; parallel
/// loops are under them after set_thread_count(1). Keep calls into other libraries out of its
/// scope: they may compute with lanes that nobody reads.
class FloatingPointTraps {
public:
    explicit FloatingPointTraps(int kinds = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW) {
        std::feclearexcept(FE_ALL_EXCEPT);  // the x87 unit would trap on what it still holds
        before_ = feenableexcept(kinds);
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
