// Progress of long work: one changing line on a terminal, a plain line now and then otherwise.
#pragma once

#include <chrono>
#include <string>

namespace inlay {

/// Writes to stderr; on a terminal at most ten times a second, otherwise at most at every tenth
/// of the way. Use from one thread.
class Progress {
public:
    /// `label` says what is done ("reading frames"), `total` is how many steps it has.
    Progress(std::string label, int total, bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `done` of the steps are behind us.
    void advance_to(int done);

private:
    using Clock = std::chrono::steady_clock;
    std::string text(int done) const;

    std::string label_;
    int total_ = 0;
    bool silent_ = false, terminal_ = false, drawn_ = false;
    int tenths_said_ = 0;
    Clock::time_point begin_, last_drawn_;
};

}  // namespace inlay
