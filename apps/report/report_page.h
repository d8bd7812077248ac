// The page that draws the figures of `inlay accuracy` and of one replay.
#pragma once

#include <string>
#include <string_view>

namespace inlay {

/// One self-contained HTML page that shows `json`: `accuracy.json`, or with `"kind": "replay"` the
/// record of one replay. `json` is valid JSON in UTF-8; it is embedded with `<`, U+2028 and U+2029
/// escaped, so no text in it can end or open an element of the page. The page loads nothing from
/// elsewhere.
std::string report_page(std::string_view json);

}  // namespace inlay
