// What a circuit must do with the packets that it gets. There is a checker for each kind.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "circuit.h"
#include "judge.h"
#include "packets.h"

// Cycles that any circuit may take besides those for its work.
constexpr uint64_t SLACK_CYCLES = 64;

// A rule was broken.
struct Broken : std::runtime_error {
    Broken(const std::string& rule, uint64_t packet, const std::string& expected,
           const std::string& came)
        : std::runtime_error(rule), packet(packet), expected(expected), came(came) {}

    uint64_t packet;
    std::string expected, came;
};

// A packet that was sent, or is being sent.
struct Sent {
    uint64_t number = 0;
    Bytes bytes;
    uint32_t beats = 0;
    Expected expected;
};
using SentPtr = std::shared_ptr<const Sent>;

struct Tally {
    std::array<uint64_t, OVERRUN + 1> statuses{};
    uint64_t judged = 0;  // packets with a status
    uint64_t transfers = 0;
};

class Checker {
public:
    virtual ~Checker() = default;

    // The first beat of a packet is about to be offered.
    virtual void sent(const SentPtr& packet) = 0;
    // The transfer of a beat.
    virtual void beat_taken(bool is_last) { (void)is_last; }
    // An output has a new payload; all of a cycle come before `offered_all`.
    virtual void offered(int output, const uint32_t* payload) = 0;
    virtual void offered_all() {}
    virtual void taken(int output, const uint32_t* payload) = 0;
    // All that was inside is gone; return the number of packets that had no status.
    virtual uint64_t reset() = 0;
    // Nothing more is to come.
    virtual bool is_done() const = 0;
    // Most cycles until the next status, without stalls, since the last change of `progress`.
    virtual uint64_t budget() const = 0;
    // Grows with each status.
    virtual uint64_t progress() const { return tally.judged; }
    // The packet whose status is next, for messages; if nothing is inside, the last one.
    virtual uint64_t oldest() const = 0;
    // Checked when all is done.
    virtual void at_end() {}
    // Packets that a checker may have on their way without a status.
    virtual bool may_send() const { return true; }

    Tally tally;
};

std::unique_ptr<Checker> make_checker(const Circuit& circuit, const Table& table);
std::unique_ptr<Checker> make_gate_checker(const Circuit& circuit);

std::string hex(const uint32_t* words, size_t count);
std::string hex(const Bytes& bytes);
inline std::string number(uint64_t value) { return std::to_string(value); }
