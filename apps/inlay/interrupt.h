// Interruption: long commands finish what they are at when they are asked to stop.
#pragma once

namespace inlay {

/// From here on the first SIGINT or SIGTERM only sets a flag, the second ends the program at once.
/// For commands that look at interrupted() between frames and then return ExitCode::interrupted.
void catch_interrupts();

/// Whether the program was asked to stop.
bool interrupted();

}  // namespace inlay
