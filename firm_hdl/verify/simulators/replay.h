// Rows of inputs in, rows of outputs out, on two copies of circuits that Verilator compiled.

#pragma once

#include <vector>

constexpr int COPIES = 2;

// A port of the circuits, of some bits; Verilator's variables for it, one for each copy.
struct Pin {
    int number;
    int width;
    void* at[COPIES];
};

// Sets the clocks of both copies, and works out what follows.
using Tick = void (*)(int level);

// Replays the rows of `stimuli`, and writes those of `results`. Inputs stand under their numbers.
// Returns what the program is to end with.
int replay(const char* stimuli, const char* results, const std::vector<Pin>& inputs,
           const std::vector<Pin>& outputs, Tick tick);
