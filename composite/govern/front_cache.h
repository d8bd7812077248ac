// Fronts measured before, kept by what they were measured of.
#pragma once

#include "composite/govern/price_front.h"

#include <filesystem>
#include <optional>
#include <string>

namespace inlay {

/// The front that was kept under `key`: a text that names all that times and errors depend on.
/// Nothing where there is none, or its file cannot be understood.
std::optional<PriceFront> kept_front(const std::filesystem::path& folder, const std::string& key);

/// Keeps a front, in a folder that is made if need be. Throws Error (cannot_create, disk_fault).
void keep_front(const std::filesystem::path& folder, const std::string& key,
                const PriceFront& front);

}  // namespace inlay
