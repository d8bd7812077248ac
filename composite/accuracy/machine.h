// Machine: what a time was measured on, and when.
#pragma once

#include <string>

namespace inlay {

struct Machine {
    std::string cpu;  // model name
    int threads = 0;  // hardware threads
    double memory_gib = 0;
    std::string system;    // kernel and architecture
    std::string compiler;  // name and version
};

Machine this_machine();

/// One JSON object, as the reports and run.json hold it.
std::string to_json_text(const Machine& machine);

/// Reads it back. Throws Error (bad_data); `place` names the text in the message.
Machine machine_from_json(const std::string& text, const std::string& place);

/// The time of day in UTC, as 2026-01-31T12:00:00Z.
std::string utc_now();

}  // namespace inlay
