// Frame lists as the command line has them: "0-99x2,150".
#pragma once

#include <string>
#include <vector>

namespace inlay {

/// first, first + step, ... up to last.
struct FrameRange {
    int first = 0, last = 0, step = 1;
};

/// No range at all means every frame.
struct FrameList {
    std::vector<FrameRange> ranges;
    bool contains(int frame) const;
};

/// Parses items N, A-B or A-BxS, separated by commas; "" and "all" are every frame. Throws Error
/// (usage) that names the item.
FrameList parse_frames(const std::string& text);

/// Those of the `available` numbers (ascending) that the list contains. Throws Error (usage) if
/// there are none.
std::vector<int> select_frames(const FrameList& list, const std::vector<int>& available);

}  // namespace inlay
