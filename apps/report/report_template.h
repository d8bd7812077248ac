// The report page before and after its data, as bundle.mjs makes it of src/.
#pragma once

#include <string_view>

namespace inlay {

extern const std::string_view report_head;
extern const std::string_view report_tail;

}  // namespace inlay
