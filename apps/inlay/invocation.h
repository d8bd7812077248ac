// How the program was called, for the files that describe a run.
#pragma once

#include <string>
#include <vector>

namespace inlay {

/// Keeps the arguments as they were given, the program's name first. Call once, at the start.
void remember_invocation(int argc, char** argv);

/// What was kept.
const std::vector<std::string>& invocation();

}  // namespace inlay
