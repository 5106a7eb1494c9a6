// A circuit in Verilator, as one input stream of beats and any number of output streams.
//
// A wrapper in Verilog gives each circuit the same ports. All but the clock are multiples of 32
// bits, so that a pointer to 32-bit words reaches them. Payloads begin with a word of flags.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

enum class CircuitKind { Deserializer, Loop, Gate };

struct Output {
    std::string name;
    const uint32_t* payload = nullptr;
    int words = 0;
};

struct Circuit {
    static constexpr uint32_t VALID = 1, LAST = 2, RUN = 4;

    virtual ~Circuit() = default;
    virtual void set_clock(bool is_high) = 0;
    virtual void evaluate() = 0;

    std::string name;
    CircuitKind kind = CircuitKind::Deserializer;
    // A gate that drops instead of holding the link.
    bool drops = false;
    int bus_bytes = 0;
    uint32_t memory_bytes = 0, memory_packets = 0;
    // `keep` is the number of valid lanes, and not a bit for each.
    bool counts_lanes = false;

    // Inputs. `control` is of VALID, LAST and RUN, which is low in a reset.
    uint32_t* control = nullptr;
    uint32_t* data = nullptr;
    uint32_t* keep = nullptr;
    uint32_t* ready = nullptr;
    // Outputs.
    const uint32_t* accept = nullptr;
    const uint32_t* valid = nullptr;
    std::vector<Output> outputs;
    // Counters of a gate, by status.
    const uint32_t* counters = nullptr;
};

// Written by Python for each type and bus width.
std::vector<Circuit*> make_circuits();
