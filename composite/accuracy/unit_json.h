// UnitRun <-> JSON text: what an interrupted run leaves behind, and goes on from.
#pragma once

#include "composite/accuracy/unit.h"

#include <string>

namespace inlay {

std::string to_json_text(const UnitRun& unit);

/// Throws Error (bad_data) naming `place` when the text is not what to_json_text() writes.
UnitRun unit_from_json(const std::string& text, const std::string& place);

}  // namespace inlay
