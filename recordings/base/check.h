// How boundaries refuse bad input: one exception, which carries the exit code the program ends
// with.
#pragma once

#include <stdexcept>
#include <string>

namespace inlay {

/// Exit codes of the program (sysexits where they fit).
enum class ExitCode : int {
    done = 0,
    usage = 2,
    bad_data = 65,
    input_missing = 66,
    cannot_create = 73,
    disk_fault = 74,
    interrupted = 130
};

/// Bad input or a failing system. The message names the file and the place in it, what was found,
/// what was expected, and a remedy.
class Error : public std::runtime_error {
public:
    Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

/// Throws Error with `code` unless `condition` holds.
inline void require(bool condition, const std::string& message,
                    ExitCode code = ExitCode::bad_data) {
    if (!condition) throw Error(code, message);
}

/// The same for a fixed text, which costs nothing unless it is thrown.
inline void require(bool condition, const char* message, ExitCode code = ExitCode::bad_data) {
    if (!condition) throw Error(code, message);
}

}  // namespace inlay
