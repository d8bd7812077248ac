// Where the memory of a frame's images goes when they are freed.
#pragma once

namespace inlay {

/// Keeps what is freed for the next frame's images, which are as large: given back to the system
/// and asked for again, every page of it would be cleared first, on one thread. For programs; call
/// once, before any thread. Does nothing where the C library has no such switch.
void keep_freed_memory();

}  // namespace inlay
