// Memory gone through once, at full speed: the limit of whatever has to touch as much.
#pragma once

#include "recordings/base/image.h"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace inlay {

/// What is read, and how much is written.
struct Traffic {
    std::vector<std::span<const std::byte>> read;
    std::size_t written = 0;  // bytes

    template <class Value>
    void reads(std::span<const Value> values) {
        if (!values.empty()) read.push_back(std::as_bytes(values));
    }
    template <class Pixel>
    void reads(const Image<Pixel>& image) {
        reads(std::span(image.pixels));
    }
    template <class Pixel>
    void writes(const Image<Pixel>& image) {
        written += image.pixels.size() * sizeof(Pixel);
    }
};

/// Read and written.
double bytes_of(const Traffic& traffic);

/// A function that does just that, on all threads; what is read must outlive it.
std::function<void()> streaming(const Traffic& traffic);

/// A function that copies `bytes` from one place to another, on all threads.
std::function<void()> copying(std::size_t bytes);

}  // namespace inlay
