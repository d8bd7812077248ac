#include "apps/inlay/invocation.h"

namespace inlay {
namespace {

std::vector<std::string>& kept() {
    static std::vector<std::string> arguments;
    return arguments;
}

}  // namespace

void remember_invocation(int argc, char** argv) { kept().assign(argv, argv + argc); }

const std::vector<std::string>& invocation() { return kept(); }

}  // namespace inlay
