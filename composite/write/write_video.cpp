#include "composite/write/write_video.h"

#include "recordings/base/check.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <system_error>
#include <utility>

extern char** environ;

namespace inlay {
namespace {

int even(int size) { return size + size % 2; }

/// The encoder's command line. Threads are fixed (x264's output depends on their number) and no
/// version or date is stored, so that equal frames give equal bytes.
std::vector<std::string> encoder_arguments(const VideoSettings& s, int width, int height,
                                           const std::string& file) {
    const std::string size = std::to_string(even(width)) + "x" + std::to_string(even(height));
    return {s.encoder, "-nostdin", "-hide_banner", "-loglevel", "error", "-y",
            // input
            "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", size, "-framerate",
            std::to_string(s.frames_per_second), "-i", "pipe:0",
            // picture
            "-vf", "scale=out_color_matrix=bt709:out_range=tv", "-pix_fmt", "yuv420p",
            "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709",
            // coding
            "-c:v", "libx264", "-preset", "medium", "-crf", std::to_string(s.quality), "-threads",
            "2", "-flags", "+bitexact", "-fflags", "+bitexact", "-map_metadata", "-1", "-movflags",
            "+faststart",
            // output
            "-f", "mp4", "file:" + file};
}

/// A connected pair of sockets: ours, and the encoder's standard input. Unlike a pipe it lets us
/// write without SIGPIPE when the encoder is gone.
std::pair<Descriptor, Descriptor> connected_pair(const std::filesystem::path& file) {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
        throw_write_error(file, errno);
    return {Descriptor(ends[0]), Descriptor(ends[1])};
}

/// Starts `arguments` with the given standard input and error; returns posix_spawnp's error
/// number, 0 for success. The process is in a group of its own, so that an interrupt from the
/// keyboard lets it finish what it was given.
int spawn(pid_t& process, const std::vector<std::string>& arguments, int input, int messages) {
    std::vector<std::string> copies = arguments;
    std::vector<char*> pointers;
    for (std::string& argument : copies)
        pointers.push_back(argument.data());
    pointers.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, messages, STDERR_FILENO);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, 0);
    const int error =
        posix_spawnp(&process, pointers[0], &actions, &attributes, pointers.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

std::string contents_of(std::FILE* file) {
    std::string text;
    std::rewind(file);
    std::array<char, 512> block{};
    while (const std::size_t count = std::fread(block.data(), 1, block.size(), file))
        text.append(block.data(), count);
    while (!text.empty() && text.back() == '\n')
        text.pop_back();
    return text;
}

bool says(const std::string& text, int error_number) {
    return text.find(std::generic_category().message(error_number)) != std::string::npos;
}

}  // namespace

VideoWriter::VideoWriter(const std::filesystem::path& file, int width, int height,
                         const VideoSettings& settings)
    : file_(file), width_(width), height_(height), encoder_(settings.encoder) {
    require(width > 0 && height > 0, file.string() + ": a video needs at least one pixel");
    require(std::isfinite(settings.frames_per_second) && settings.frames_per_second > 0 &&
                settings.quality >= 0 && settings.quality <= 51,
            file.string() + ": a video needs frames_per_second > 0 and quality in 0..51",
            ExitCode::usage);
    packed_.resize(std::size_t(even(width)) * std::size_t(even(height)) * 3);
    start(settings);
}

void VideoWriter::start(const VideoSettings& settings) {
    messages_.reset(std::tmpfile());
    if (!messages_) throw_write_error(file_.target(), errno);
    auto [ours, theirs] = connected_pair(file_.target());
    const auto arguments = encoder_arguments(settings, width_, height_, file_.partial().string());
    const int error = spawn(process_, arguments, theirs.get(), ::fileno(messages_.get()));
    socket_ = std::move(ours);
    if (error == 0) return;
    process_ = -1;
    throw Error(ExitCode::cannot_create, file_.target().string() + ": cannot start the encoder \"" +
                                             encoder_ + "\" (" +
                                             std::generic_category().message(error) +
                                             "): install ffmpeg, or leave out the video");
}

VideoWriter::~VideoWriter() {
    if (process_ < 0) return;
    ::kill(process_, SIGKILL);
    wait_for_encoder();
}

void VideoWriter::write(const Image<EncodedRgb>& frame) {
    require(frame.width == width_ && frame.height == height_,
            file_.target().string() + ": a frame is " + std::to_string(frame.width) + " x " +
                std::to_string(frame.height) + " px, the video " + std::to_string(width_) + " x " +
                std::to_string(height_));
    require(socket_.open(), file_.target().string() + ": the video is closed", ExitCode::usage);
    std::size_t i = 0;
    for (int y = 0; y < even(height_); ++y)
        for (int x = 0; x < even(width_); ++x) {
            const EncodedRgb& c = frame(std::min(x, width_ - 1), std::min(y, height_ - 1));
            packed_[i++] = c.r;
            packed_[i++] = c.g;
            packed_[i++] = c.b;
        }
    for (std::size_t sent = 0; sent < packed_.size();) {
        const ssize_t count =
            ::send(socket_.get(), packed_.data() + sent, packed_.size() - sent, MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) throw_encoder_error(wait_for_encoder());
        sent += std::size_t(count);
    }
}

void VideoWriter::close() {
    require(process_ >= 0, file_.target().string() + ": the video is closed", ExitCode::usage);
    const int status = wait_for_encoder();
    // ffmpeg 5.1 ends with 0 even where it could not write the end of the file, but it says so
    const bool complained = !contents_of(messages_.get()).empty();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || complained) throw_encoder_error(status);
    file_.commit();
}

/// Ends the encoder's input and waits; returns the status of waitpid.
int VideoWriter::wait_for_encoder() {
    socket_.close();
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
}

void VideoWriter::throw_encoder_error(int status) {
    const std::string words = contents_of(messages_.get());
    const bool killed_by_limit = WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ;
    const bool disk =
        killed_by_limit || says(words, ENOSPC) || says(words, EFBIG) || says(words, EIO);
    const std::string end = WIFSIGNALED(status)
                                ? "signal " + std::to_string(WTERMSIG(status))
                                : "exit status " + std::to_string(WEXITSTATUS(status));
    throw Error(disk ? ExitCode::disk_fault : ExitCode::cannot_create,
                file_.target().string() + ": the encoder \"" + encoder_ + "\" ended with " + end +
                    (words.empty() ? "" : ", saying: " + words) +
                    (disk ? "; free some space and run again"
                          : "; check that it can write H.264, or leave out the video"));
}

}  // namespace inlay
