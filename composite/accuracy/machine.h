// Machine: what a time was measured on.
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

}  // namespace inlay
