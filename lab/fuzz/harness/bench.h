// The surroundings of a circuit: they send packets, take what comes, and check each cycle.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "checker.h"
#include "circuit.h"
#include "packets.h"
#include "stalls.h"
#include "table.h"

struct Counts {
    uint64_t packets = 0;    // sent
    uint64_t bad = 0;        // of these, with another status than OK by the judge
    uint64_t discarded = 0;  // lost in a reset
    uint64_t resets = 0;
    uint64_t cycles = 0;
    std::array<uint64_t, DAMAGE_NAMES.size()> damages{};
};

class Bench {
public:
    // Packets of an episode, which begins with a reset and follows from its number alone.
    static constexpr uint64_t EPISODE = 256;

    Bench(Circuit& circuit, const Table& table, uint64_t seed);

    // Throws `Broken`.
    void run(uint64_t episode);

    // For messages: a packet that was sent in the last episode, or nothing.
    const Bytes* bytes_of(uint64_t packet) const;

    // Cycles of the last episode.
    uint64_t cycle() const { return counts.cycles - start_; }

    Counts counts;
    const Tally& tally() const { return checker_->tally; }

private:
    void reset(Random& random, bool is_start);
    void make(Random& random, uint64_t number);
    void offer(Random& random);
    void look();
    void do_cycle(Random& random);
    void step();
    void check_progress(bool did_something);
    bool all_sent() const { return next_ == sent_.size() && !is_offering_; }

    Circuit& circuit_;
    const Table& table_;
    uint64_t seed_;
    Judge judge_;
    Writer writer_;
    Damager damager_;
    std::unique_ptr<Checker> checker_;
    Stalls stalls_;

    std::vector<SentPtr> sent_;  // of this episode
    size_t next_ = 0;            // to be sent
    size_t beat_ = 0;            // of the packet that is being sent
    bool is_offering_ = false;

    // Valid streams, and payloads that were offered and not taken.
    std::vector<uint32_t> valid_, held_;
    std::vector<std::vector<uint32_t>> payloads_;
    uint64_t start_ = 0;   // cycles before this episode
    uint64_t idle_ = 0;    // cycles without a transfer
    uint64_t waited_ = 0;    // cycles since progress, in which nothing was stalled
    uint64_t progress_ = 0;  // of the checker, at the last cycle
};
