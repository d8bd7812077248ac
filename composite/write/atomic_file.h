// Files that appear under their name only when complete: write beside, sync, rename.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace inlay {

/// A file in the making. Whatever writes it writes to `partial()`, a hidden name in the same
/// folder; `commit()` gives it its final name. Without a commit the partial file is removed and
/// what stood under the final name stays.
class PendingFile {
public:
    explicit PendingFile(std::filesystem::path target);
    ~PendingFile();
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;

    const std::filesystem::path& target() const { return target_; }
    const std::filesystem::path& partial() const { return partial_; }

    /// Syncs the partial file to disk and renames it. Throws Error (disk_fault, cannot_create).
    void commit();

private:
    std::filesystem::path target_, partial_;
    bool committed_ = false;
};

/// Writes `bytes` to `target`, which holds either them or what it held before. Throws Error:
/// cannot_create when the folder is missing or not writable, disk_fault when the disk is full or
/// fails. (A process under a file size limit must ignore SIGXFSZ to get the error.)
void write_file(const std::filesystem::path& target, std::span<const std::byte> bytes);

/// write_file() of the bytes of a text.
void write_text(const std::filesystem::path& target, const std::string& text);

/// Makes a folder and its parents, unless they exist. Throws Error (cannot_create, disk_fault).
void make_folder(const std::filesystem::path& folder);

/// Throws the Error that fits a failed system call on `file`: disk_fault for a full or failing
/// disk, cannot_create for everything else. `error_number` is errno's value.
[[noreturn]] void throw_write_error(const std::filesystem::path& file, int error_number);

}  // namespace inlay
