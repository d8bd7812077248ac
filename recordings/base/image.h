// Image<Pixel>: a grid of pixels as a value.
#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

namespace inlay {

/// Row-major grid of pixels; (0, 0) is the top-left pixel. Do not use with Pixel = bool.
template <class Pixel>
struct Image {
    int width = 0;   // px
    int height = 0;  // px
    std::vector<Pixel> pixels;

    Image() = default;
    Image(int w, int h, const Pixel& fill = Pixel{})
        : width(w), height(h), pixels(std::size_t(w) * std::size_t(h), fill) {}

    bool empty() const { return pixels.empty(); }
    bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
    std::size_t index(int x, int y) const {
        assert(contains(x, y));
        return std::size_t(y) * std::size_t(width) + std::size_t(x);
    }
    Pixel& operator()(int x, int y) { return pixels[index(x, y)]; }
    const Pixel& operator()(int x, int y) const { return pixels[index(x, y)]; }
    std::span<Pixel> row(int y) { return {pixels.data() + index(0, y), std::size_t(width)}; }
    std::span<const Pixel> row(int y) const {
        return {pixels.data() + index(0, y), std::size_t(width)};
    }
};

template <class A, class B>
bool same_size(const Image<A>& a, const Image<B>& b) {
    return a.width == b.width && a.height == b.height;
}

}  // namespace inlay
