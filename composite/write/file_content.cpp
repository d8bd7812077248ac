#include "composite/write/file_content.h"

#include "recordings/base/check.h"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <iterator>

namespace inlay {

std::string content_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    require(stream.is_open() && !stream.bad(),
            file.string() + ": cannot be read; check its permissions", ExitCode::input_missing);
    return bytes;
}

std::string fingerprint_of(const std::string& bytes) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const char c : bytes)
        hash = (hash ^ std::uint8_t(c)) * 0x100000001b3ULL;
    return fmt::format("{:016x}", hash);
}

}  // namespace inlay
