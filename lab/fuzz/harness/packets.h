// Packets to send: good ones, and good ones that were damaged.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "random.h"
#include "table.h"

using Bytes = std::vector<uint8_t>;

// The place of a length in a packet, to play with.
struct LengthAt {
    size_t at = 0;
    uint32_t value = 0;  // as on the wire
    const Node* node = nullptr;
};

struct Written {
    Bytes bytes;
    std::vector<LengthAt> lengths;
};

// Writes random messages as good packets.
class Writer {
public:
    explicit Writer(const Table& table) : table_(table) {}

    Written write(Random& random);

private:
    void node(const Node& node);
    void align(int bytes);
    uint32_t length(const Node& node);
    void number(int bytes);
    void put(uint64_t value, int bytes);

    const Table& table_;
    Random* random_ = nullptr;
    Written out_;
    size_t room_ = 0;     // a packet of so many bytes gets no more items
    uint32_t most_ = 0;   // usual number of items
    int depth_ = 0;
};

enum class Damage {
    Cut, CutAnywhere, Splice, Flip, Length, Header, Trailing, Empty, Insert, Erase, Rubbish,
};

constexpr std::array<const char*, 11> DAMAGE_NAMES = {
    "cut", "cut anywhere", "splice", "flip", "length", "header",
    "trailing", "empty", "insert", "erase", "rubbish"};

// Damages good packets. Some of the results are good packets again: the judge decides.
class Damager {
public:
    Damager(const Table& table, uint64_t seed) : writer_(table), table_(table), seed_(seed) {}

    Bytes damaged(Random& random, Damage& kind);

    // Consecutive numbers cut the same packet at consecutive bytes, then the next packet.
    Bytes cut(uint64_t number);

private:
    bool damage(Random& random, Damage kind, Written& packet);
    bool play_with_lengths(Random& random, Written& packet);
    void replace_length(Random& random, const LengthAt& length, Bytes& bytes);

    Writer writer_;
    const Table& table_;
    uint64_t seed_;
    // The packet that is cut at every byte, and the number of its first cut.
    Bytes victim_;
    uint64_t first_cut_ = 0;
    uint64_t victims_ = 0;
};
