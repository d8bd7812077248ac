// The bytes of a file, and a short name for them.
#pragma once

#include <filesystem>
#include <string>

namespace inlay {

/// All bytes of a file. Throws Error (input_missing) where it cannot be read.
std::string content_of(const std::filesystem::path& file);

/// 16 hexadecimal digits (FNV-1a, 64 bit): tells changed bytes, not forged ones.
std::string fingerprint_of(const std::string& bytes);

}  // namespace inlay
