#include "stalls.h"

#include <algorithm>

void Stalls::choose(Random& random, bool may_wait_for_all) {
    one_ = density(random);
    other_ = density(random);
    input_ = density(random);
    others_.assign(words_, 0);
    for (uint32_t& each : others_) each = static_cast<uint32_t>(random.next());
    has_pauses_ = random.one_in(4);
    longest_ = random.one_in(4) ? 300 : 40;
    longs_.clear();
    if (random.one_in(2))
        for (uint32_t left = 1 + random.below(3); left; --left)
            longs_.push_back({random.below(static_cast<uint32_t>(outputs_)), 1, false});
    waits_for_all_ = may_wait_for_all && random.one_in(4);
    pause_ = 0;
}

Stalls::Density Stalls::density(Random& random) {
    static constexpr Density CHOICES[] = {Density::Always, Density::Always, Density::Always,
                                          Density::Often,  Density::Half,   Density::Seldom,
                                          Density::Rarely};
    return CHOICES[random.below(sizeof CHOICES / sizeof CHOICES[0])];
}

// Each bit is one with the probability 1, 3/4, 1/2, 1/4 or 1/16.
uint32_t Stalls::mask(Random& random, Density density) {
    if (density == Density::Always) return ~0u;
    const uint64_t bits = random.next();
    const uint32_t a = static_cast<uint32_t>(bits), b = static_cast<uint32_t>(bits >> 32);
    switch (density) {
        case Density::Often: return a | b;
        case Density::Half: return a;
        case Density::Seldom: return a & b;
        default: {
            const uint64_t more = random.next();
            return a & b & static_cast<uint32_t>(more) & static_cast<uint32_t>(more >> 32);
        }
    }
}

void Stalls::take(Random& random, const uint32_t* valid, uint32_t* ready) {
    if (waits_for_all_) {
        // As the contract allows it: nothing is taken before all is valid.
        bool all = true;
        for (size_t n = 0; n < outputs_; ++n) all &= valid[n / 32] >> n % 32 & 1;
        std::fill(ready, ready + words_, all ? ~0u : 0u);
        return;
    }
    for (size_t n = 0; n < words_; ++n) {
        ready[n] = mask(random, one_);
        if (other_ != one_)
            ready[n] = (ready[n] & ~others_[n]) | (mask(random, other_) & others_[n]);
    }
    for (Long& each : longs_) {
        if (--each.left == 0) {
            each.is_closed = !each.is_closed;
            each.left = 1 + random.below(longest_);
        }
        if (each.is_closed) ready[each.output / 32] &= ~(1u << each.output % 32);
    }
}

bool Stalls::offers(Random& random) {
    if (pause_) {
        --pause_;
        return false;
    }
    if (has_pauses_ && random.one_in(64)) pause_ = random.below(longest_);
    return mask(random, input_) & 1;
}
