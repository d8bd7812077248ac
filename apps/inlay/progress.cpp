#include "apps/inlay/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace inlay {

Progress::Progress(std::string label, int total, bool quiet)
    : label_(std::move(label)),
      total_(std::max(total, 1)),
      silent_(quiet),
      terminal_(::isatty(STDERR_FILENO) != 0),
      begin_(Clock::now()) {}

Progress::~Progress() {
    if (drawn_) std::fputc('\n', stderr);
}

std::string Progress::text(int done) const {
    std::string text = label_ + " " + std::to_string(done) + "/" + std::to_string(total_);
    const double elapsed = std::chrono::duration<double>(Clock::now() - begin_).count();
    if (done <= 0 || done >= total_ || elapsed < 1) return text;
    char left[48];
    std::snprintf(left, sizeof left, ", %.0f s left", elapsed / done * (total_ - done));
    return text + left;
}

void Progress::advance_to(int done) {
    if (silent_) return;
    if (!terminal_) {
        const int tenths = int(10LL * done / total_);
        if (tenths <= tenths_said_) return;
        tenths_said_ = tenths;
        std::fprintf(stderr, "%s\n", text(done).c_str());
        return;
    }
    const auto now = Clock::now();
    if (drawn_ && done < total_ && now - last_drawn_ < std::chrono::milliseconds(100)) return;
    last_drawn_ = now;
    drawn_ = true;
    std::fprintf(stderr, "\r%s\x1b[K", text(done).c_str());
    std::fflush(stderr);
}

}  // namespace inlay
