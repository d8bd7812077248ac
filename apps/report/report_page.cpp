// Embeds data into the report page so that the data cannot break the page.
#include "apps/report/report_page.h"

#include "apps/report/report_template.h"

namespace inlay {
namespace {

constexpr std::string_view line_separators = "\xE2\x80";  // the first two bytes of U+2028 and 2029

/// Appends JSON with the characters escaped that mean something to HTML or end a line of a script.
/// All three can only occur in strings of JSON, where an escape means the same.
void append_escaped(std::string& page, std::string_view json) {
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char last = i + 2 < json.size() ? json[i + 2] : '\0';
        if (json[i] == '<') {
            page += "\\u003c";
        } else if (json.substr(i, 2) == line_separators && (last == '\xA8' || last == '\xA9')) {
            page += last == '\xA8' ? "\\u2028" : "\\u2029";
            i += 2;
        } else {
            page += json[i];
        }
    }
}

}  // namespace

std::string report_page(std::string_view json) {
    std::string page;
    page.reserve(report_head.size() + json.size() + json.size() / 64 + report_tail.size());
    page += report_head;
    append_escaped(page, json);
    page += report_tail;
    return page;
}

}  // namespace inlay
