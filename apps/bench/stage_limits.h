// The least that stages of a frame have to do which wait for files, codecs or rays.
#pragma once

#include "recordings/base/lens.h"
#include "recordings/base/pose.h"
#include "render/sample/environment_sampler.h"

#include "apps/bench/bare_embree.h"

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace inlay {

/// The PNG and JPEG files of a recording with the frame's number, in six digits, in their names;
/// none where files are named otherwise.
std::vector<std::filesystem::path> picture_files(const std::filesystem::path& recording, int frame);

/// The bytes of all files, which the page cache has after the first time.
std::vector<std::vector<unsigned char>> read_files(const std::vector<std::filesystem::path>& files);

/// Decodes pictures with OpenCV as a recording's readers do, and drops them.
void decode_pictures(const std::vector<std::vector<unsigned char>>& files);

/// Writes a file and waits until it is on the disk. Throws Error as write_file() does.
void write_plainly(const std::filesystem::path& file, std::span<const std::byte> bytes);

/// A ray through every pixel's centre, in packets of 4 x 4 pixels.
BareRays pixel_rays(const Lens& lens, const Pose& world_from_camera, float nearest);

/// Draws `count` samples of an environment from plain random numbers, on all threads.
void draw_samples(const EnvironmentSampler& environment, int count);

}  // namespace inlay
