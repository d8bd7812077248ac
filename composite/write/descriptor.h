// Descriptor: a POSIX file descriptor that closes itself.
#pragma once

#include <unistd.h>

#include <utility>

namespace inlay {

class Descriptor {
public:
    Descriptor() = default;
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        close();
        fd_ = std::exchange(other.fd_, -1);
        return *this;
    }
    ~Descriptor() { close(); }

    bool open() const { return fd_ >= 0; }
    int get() const { return fd_; }
    void close() {
        if (open()) ::close(std::exchange(fd_, -1));
    }

private:
    int fd_ = -1;
};

}  // namespace inlay
