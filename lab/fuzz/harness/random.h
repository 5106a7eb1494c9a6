// Random numbers: SplitMix64 (Steele, Lea and Flood, 2014). Equal seeds give equal numbers on every
// machine, which the standard library's distributions do not promise.
#pragma once

#include <cstdint>

class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}

    // Make a seed of several numbers.
    static uint64_t mixed(uint64_t a, uint64_t b, uint64_t c) {
        Random first(a);
        Random second(first.next() ^ b);
        Random third(second.next() ^ c);
        return third.next();
    }

    uint64_t next() {
        uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }

    // A number below `n`.
    uint32_t below(uint32_t n) { return static_cast<uint32_t>((next() >> 32) * n >> 32); }

    // True once in `n` times.
    bool one_in(uint32_t n) { return below(n) == 0; }

    uint32_t word() { return static_cast<uint32_t>(next()); }

    uint8_t byte() { return static_cast<uint8_t>(next() >> 56); }

private:
    uint64_t state_;
};
