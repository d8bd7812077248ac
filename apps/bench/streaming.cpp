#include "apps/bench/streaming.h"

#include "recordings/base/parallel.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>

namespace inlay {
namespace {

constexpr std::size_t piece = 1 << 16;  // bytes of a thread's turn

template <class Byte>
std::vector<std::span<Byte>> pieces_of(std::span<Byte> bytes) {
    std::vector<std::span<Byte>> pieces;
    for (std::size_t at = 0; at < bytes.size(); at += piece)
        pieces.push_back(bytes.subspan(at, std::min(piece, bytes.size() - at)));
    return pieces;
}

/// Whole words alone; one sum of them all, so that no read can be left out.
std::uint64_t sum_of(std::span<const std::byte> bytes) {
    std::uint64_t sum = 0;
    for (std::size_t at = 0; at + sizeof(sum) <= bytes.size(); at += sizeof(sum)) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + at, sizeof(word));
        sum += word;
    }
    return sum;
}

}  // namespace

double bytes_of(const Traffic& traffic) {
    double sum = double(traffic.written);
    for (const auto& bytes : traffic.read)
        sum += double(bytes.size());
    return sum;
}

std::function<void()> streaming(const Traffic& traffic) {
    std::vector<std::span<const std::byte>> from;
    for (const auto& bytes : traffic.read)
        for (const auto& part : pieces_of(bytes))
            from.push_back(part);
    const auto target = std::make_shared<std::vector<std::byte>>(traffic.written);
    return [from, target, to = pieces_of(std::span(*target))] {
        parallel_for(int(from.size()),
                     [&](int i) { benchmark::DoNotOptimize(sum_of(from[std::size_t(i)])); });
        parallel_for(int(to.size()), [&](int i) {
            std::ranges::fill(to[std::size_t(i)], std::byte{1});
            benchmark::ClobberMemory();
        });
    };
}

std::function<void()> copying(std::size_t bytes) {
    const auto source = std::make_shared<std::vector<std::byte>>(bytes, std::byte{1});
    const auto target = std::make_shared<std::vector<std::byte>>(bytes);
    return
        [source, target, from = pieces_of(std::span(*source)), to = pieces_of(std::span(*target))] {
            parallel_for(int(from.size()), [&](int i) {
                std::ranges::copy(from[std::size_t(i)], to[std::size_t(i)].begin());
                benchmark::ClobberMemory();
            });
        };
}

}  // namespace inlay
