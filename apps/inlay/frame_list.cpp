#include "apps/inlay/frame_list.h"

#include "recordings/base/check.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

namespace inlay {
namespace {

[[noreturn]] void refuse(std::string_view item, const std::string& expected) {
    throw Error(ExitCode::usage,
                "--frames: found '" + std::string(item) + "', expected " + expected);
}

int parse_whole(std::string_view text, std::string_view item) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || text.front() == '-' || error != std::errc() ||
        end != text.data() + text.size())
        refuse(item, "N, A-B or A-BxS with whole numbers, as in 0-99x2,150");
    return value;
}

FrameRange parse_item(std::string_view item) {
    const std::size_t dash = item.find('-');
    if (dash == std::string_view::npos) {
        const int only = parse_whole(item, item);
        return {only, only, 1};
    }
    const std::size_t cross = std::min(item.find('x', dash), item.size());
    FrameRange range;
    range.first = parse_whole(item.substr(0, dash), item);
    range.last = parse_whole(item.substr(dash + 1, cross - dash - 1), item);
    if (cross < item.size()) range.step = parse_whole(item.substr(cross + 1), item);
    if (range.last < range.first) refuse(item, "a range that does not end before it begins");
    if (range.step < 1) refuse(item, "a step of 1 or more");
    return range;
}

}  // namespace

bool FrameList::contains(int frame) const {
    return ranges.empty() || std::ranges::any_of(ranges, [frame](const FrameRange& r) {
               return frame >= r.first && frame <= r.last && (frame - r.first) % r.step == 0;
           });
}

FrameList parse_frames(const std::string& text) {
    FrameList list;
    if (text.empty() || text == "all") return list;
    std::string_view rest = text;
    while (true) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        list.ranges.push_back(parse_item(rest.substr(0, comma)));
        if (comma == rest.size()) return list;
        rest.remove_prefix(comma + 1);
    }
}

std::vector<int> select_frames(const FrameList& list, const std::vector<int>& available) {
    std::vector<int> selected;
    std::ranges::copy_if(available, std::back_inserter(selected),
                         [&](int frame) { return list.contains(frame); });
    if (selected.empty())
        throw Error(ExitCode::usage,
                    available.empty()
                        ? "--frames: there are no frames to select from"
                        : "--frames: selects none of the recording's frames, which run from " +
                              std::to_string(available.front()) + " to " +
                              std::to_string(available.back()));
    return selected;
}

}  // namespace inlay
