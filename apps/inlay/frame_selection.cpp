#include "apps/inlay/frame_selection.h"

#include "recordings/base/check.h"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace inlay {

std::vector<int> shard_of(const std::vector<int>& frames, const std::string& text) {
    if (text.empty()) return frames;
    int part = 0, parts = 0;
    const char* end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, part);
    const bool split = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
    const auto second = split ? std::from_chars(first.ptr + 1, end, parts) : first;
    require(split && second.ec == std::errc() && second.ptr == end && part >= 1 && part <= parts,
            "--shard " + text + ": expected I/N with 1 <= I <= N, as in 1/4", ExitCode::usage);
    const auto bound = [&](int i) {
        return std::ptrdiff_t(frames.size() * std::size_t(i) / std::size_t(parts));
    };
    return {frames.begin() + bound(part - 1), frames.begin() + bound(part)};
}

std::vector<FrameTask> plan_frames(const std::vector<int>& available,
                                   const std::vector<int>& composited, bool temporal) {
    std::vector<FrameTask> tasks;
    if (composited.empty()) return tasks;
    const auto wanted = [&](int frame) {
        return std::find(composited.begin(), composited.end(), frame) != composited.end();
    };
    const int last = *std::max_element(composited.begin(), composited.end());
    for (std::size_t i = 0; i < available.size() && available[i] <= last; ++i) {
        FrameTask task{available[i], FrameWork::track};
        if (wanted(available[i])) {
            task.work = FrameWork::compose;
        } else if (temporal && i + 1 < available.size() && wanted(available[i + 1])) {
            task.work = FrameWork::sample;
        }
        tasks.push_back(task);
    }
    return tasks;
}

}  // namespace inlay
