// The part of a replay in Verilator that is the same for all types.

#include "replay.h"

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>

// What simulated time is: asked for by what links with Verilator, used by nobody.
double sc_time_stamp() { return 0; }

namespace {

// Calls `visit` with the word that has a bit, and with its place in the word. How Verilator keeps a
// port depends on its width.
template <class Visit> void visit_bit(void* at, int width, int bit, Visit visit) {
    if (width <= 8) {
        visit(*static_cast<std::uint8_t*>(at), bit);
    } else if (width <= 16) {
        visit(*static_cast<std::uint16_t*>(at), bit);
    } else if (width <= 32) {
        visit(*static_cast<std::uint32_t*>(at), bit);
    } else if (width <= 64) {
        visit(*static_cast<std::uint64_t*>(at), bit);
    } else {
        visit(static_cast<std::uint32_t*>(at)[bit / 32], bit % 32);
    }
}

void write(const Pin& pin, const std::string& bits) {
    for (int bit = 0; bit < pin.width; ++bit) {
        const std::uint64_t value = bits[pin.width - 1 - bit] == '1';
        for (void* at : pin.at) {
            visit_bit(at, pin.width, bit, [value](auto& word, int place) {
                word = (word & ~(std::uint64_t{1} << place)) | value << place;
            });
        }
    }
}

// Returns the bits that both copies agree on, and an X for each of the others.
std::string read(const Pin& pin) {
    std::string bits(pin.width, 'X');
    for (int bit = 0; bit < pin.width; ++bit) {
        int ones = 0;
        for (void* at : pin.at) {
            visit_bit(at, pin.width, bit,
                      [&ones](auto& word, int place) { ones += word >> place & 1; });
        }
        if (ones == 0 || ones == COPIES) {
            bits[pin.width - 1 - bit] = ones ? '1' : '0';
        }
    }
    return bits;
}

}  // namespace

int replay(const char* stimuli, const char* results, const std::vector<Pin>& inputs,
           const std::vector<Pin>& outputs, Tick tick) {
    std::ifstream rows(stimuli);
    std::ofstream seen(results);
    std::vector<std::string> before(outputs.size());
    std::size_t count, number;
    bool is_compared;
    std::string bits;
    while (rows >> count >> is_compared) {
        while (count--) {
            rows >> number >> bits;
            if (number >= inputs.size() || bits.size() != std::size_t(inputs[number].width)) {
                std::fprintf(stderr, "no input %zu of %zu bits\n", number, bits.size());
                return 1;
            }
            write(inputs[number], bits);
        }
        tick(0);
        if (is_compared) {
            for (std::size_t index = 0; index < outputs.size(); ++index) {
                bits = read(outputs[index]);
                if (bits != before[index]) {
                    seen << outputs[index].number << ' ' << bits << ' ';
                    before[index] = bits;
                }
            }
            seen << '\n';
        }
        tick(1);
    }
    seen.close();
    return seen.fail();
}
