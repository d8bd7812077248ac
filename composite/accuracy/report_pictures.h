// The pictures that a report shows beside its figures.
#pragma once

#include "composite/accuracy/accuracy_json.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace inlay {

/// A PNG in a data URL.
std::string data_url(std::span<const std::byte> png);

/// The photograph, the references, and every method at 16 samples (and unfiltered at 64), made
/// again from the same random numbers; each is also a file in `folder`/pictures.
std::vector<ReportPicture> report_pictures(const Work& work, const JudgedFrame& frame,
                                           const std::vector<Cell>& cells, const Settings& settings,
                                           const std::filesystem::path& folder);

}  // namespace inlay
