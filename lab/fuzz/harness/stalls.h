// Random stalls of the input and of every output.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "random.h"

class Stalls {
public:
    explicit Stalls(size_t outputs) : outputs_(outputs), words_((outputs + 31) / 32) {}

    // Choose how often streams stall, from never to nearly always.
    void choose(Random& random, bool may_wait_for_all);

    // Set the outputs to take in this cycle.
    void take(Random& random, const uint32_t* valid, uint32_t* ready);

    // Offer a beat in this cycle.
    bool offers(Random& random);

private:
    enum class Density { Always, Often, Half, Seldom, Rarely };

    static Density density(Random& random);
    static uint32_t mask(Random& random, Density density);

    // An output that is not taken for long.
    struct Long {
        size_t output;
        uint32_t left;   // cycles
        bool is_closed;
    };

    size_t outputs_, words_;
    Density one_ = Density::Always, other_ = Density::Always, input_ = Density::Always;
    std::vector<uint32_t> others_;  // outputs with the other density
    std::vector<Long> longs_;
    uint32_t longest_ = 1;
    uint32_t pause_ = 0;      // cycles until the next beat is offered
    bool has_pauses_ = false;
    bool waits_for_all_ = false;
};
