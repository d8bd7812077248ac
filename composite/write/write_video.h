// A video from display images, by piping them to an ffmpeg process.
#pragma once

#include "composite/write/atomic_file.h"
#include "composite/write/descriptor.h"
#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <sys/types.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace inlay {

struct VideoSettings {
    double frames_per_second = 30;   // > 0
    int quality = 18;                // x264's constant rate factor, 0 (lossless) .. 51
    std::string encoder = "ffmpeg";  // program; sought in PATH
};

/// H.264 (yuv420p, Rec. 709) in an MP4 file that appears under its name when close() succeeds.
/// Equal frames give equal bytes. Odd sizes are padded by repeating the last column or row.
class VideoWriter {
public:
    /// Starts the encoder for frames of `width` x `height` px. Throws Error (cannot_create) when
    /// there is no such program.
    VideoWriter(const std::filesystem::path& file, int width, int height,
                const VideoSettings& settings = {});

    /// Without close(): stops the encoder and leaves nothing behind.
    ~VideoWriter();
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    /// Appends a frame. Throws Error: bad_data for another size, disk_fault or cannot_create with
    /// the encoder's own words when it has stopped.
    void write(const Image<EncodedRgb>& frame);

    /// Waits for the encoder and gives the file its name. Throws Error as write() does.
    void close();

private:
    struct CloseFile {
        void operator()(std::FILE* f) const { std::fclose(f); }
    };

    void start(const VideoSettings& settings);
    int wait_for_encoder();
    [[noreturn]] void throw_encoder_error(int status);

    PendingFile file_;
    int width_ = 0, height_ = 0;  // px, as given
    std::string encoder_;
    std::unique_ptr<std::FILE, CloseFile> messages_;  // what the encoder says on stderr
    std::vector<std::uint8_t> packed_;                // one padded frame, rgb24
    Descriptor socket_;                               // to the encoder's standard input
    pid_t process_ = -1;                              // -1: not running
};

}  // namespace inlay
