#include "composite/write/atomic_file.h"

#include "composite/write/descriptor.h"
#include "recordings/base/check.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

namespace inlay {
namespace fs = std::filesystem;
namespace {

fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

fs::path hidden_beside(const fs::path& file) {
    std::string name = ".";
    name += file.filename().string();
    name += ".part";
    return folder_of(file) / name;
}

void write_all(int fd, std::span<const std::byte> bytes, const fs::path& file) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(fd, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) throw_write_error(file, errno);
        bytes = bytes.subspan(std::size_t(written));
    }
}

/// Some file systems cannot sync a folder and say EINVAL: then there is nothing to wait for.
void sync(int fd, const fs::path& file) {
    if (::fsync(fd) != 0 && errno != EINVAL && errno != EROFS) throw_write_error(file, errno);
}

}  // namespace

PendingFile::PendingFile(fs::path target)
    : target_(std::move(target)), partial_(hidden_beside(target_)) {
    require(target_.has_filename(), target_.string() + ": is no file name",
            ExitCode::cannot_create);
}

PendingFile::~PendingFile() {
    std::error_code ignored;
    if (!committed_) fs::remove(partial_, ignored);
}

void PendingFile::commit() {
    {
        const Descriptor file(::open(partial_.c_str(), O_RDONLY | O_CLOEXEC));
        if (!file.open()) throw_write_error(target_, errno);
        sync(file.get(), target_);
    }
    if (std::rename(partial_.c_str(), target_.c_str()) != 0) throw_write_error(target_, errno);
    committed_ = true;
    const Descriptor folder(::open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder.open()) sync(folder.get(), target_);
}

void write_file(const fs::path& target, std::span<const std::byte> bytes) {
    PendingFile pending(target);
    {
        const Descriptor file(
            ::open(pending.partial().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
        if (!file.open()) throw_write_error(target, errno);
        write_all(file.get(), bytes, target);
    }
    pending.commit();
}

void write_text(const fs::path& target, const std::string& text) {
    write_file(target, std::as_bytes(std::span(text)));
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw_write_error(folder, error.value());
    if (!fs::is_directory(folder, error)) throw_write_error(folder, ENOTDIR);
}

void throw_write_error(const fs::path& file, int error_number) {
    const std::string reason = std::generic_category().message(error_number);
    switch (error_number) {
        case ENOSPC:
        case EDQUOT:
        case EFBIG:
            throw Error(ExitCode::disk_fault,
                        file.string() + ": cannot be written (" + reason +
                            "): nothing was left under this name; free some space and run again");
        case EIO:
            throw Error(ExitCode::disk_fault,
                        file.string() + ": cannot be written (" + reason +
                            "): the disk reports a fault; choose another with --out");
        default:
            throw Error(ExitCode::cannot_create,
                        file.string() + ": cannot be created (" + reason +
                            "): choose a folder that exists and that you may write to");
    }
}

}  // namespace inlay
