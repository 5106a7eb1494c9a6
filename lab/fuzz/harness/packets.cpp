#include "packets.h"

#include <algorithm>

namespace {

constexpr int HEADER_BYTES = 4;
// Packets are short, so that many fit into a second; some are longer.
constexpr uint32_t USUAL_ROOM = 96;
constexpr uint32_t LARGE_ROOM = 600;
// Items, for packets that are larger than a gate's memory.
constexpr uint32_t MANY = 400;
constexpr uint32_t MOST_ITEMS = 1000;
constexpr uint32_t LONGEST_RUBBISH = 80;

void put_at(Bytes& bytes, size_t at, uint32_t value) {
    for (int n = 0; n < 4; ++n) bytes[at + n] = static_cast<uint8_t>(value >> 8 * n);
}

}  // namespace

Written Writer::write(Random& random) {
    random_ = &random;
    out_ = {};
    depth_ = 0;
    room_ = random.below(random.one_in(16) ? LARGE_ROOM : USUAL_ROOM);
    most_ = random.one_in(4) ? 2 : random.one_in(8) ? MANY : 2 * table_.bus_bytes + 3;
    if (table_.is_cdr) {
        put(0x0100, 2);
        // Options, which a receiver ignores.
        put(random.one_in(2) ? 0 : random.next(), 2);
    }
    for (const Node& each : table_.nodes) node(each);
    if (table_.is_cdr && random.one_in(4))
        for (uint32_t left = random.below(4); left; --left) put(random.byte(), 1);
    return out_;
}

void Writer::put(uint64_t value, int bytes) {
    for (int n = 0; n < bytes; ++n) out_.bytes.push_back(static_cast<uint8_t>(value >> 8 * n));
}

// Padding may have any value.
void Writer::align(int bytes) {
    if (!table_.is_cdr) return;
    while ((out_.bytes.size() - HEADER_BYTES) % bytes)
        put(random_->one_in(2) ? 0 : random_->byte(), 1);
}

void Writer::number(int bytes) {
    switch (random_->below(8)) {
        case 0: put(0, bytes); break;
        case 1: put(~uint64_t{0}, bytes); break;
        case 2: put(1, bytes); break;
        default: put(random_->next(), bytes);
    }
}

uint32_t Writer::length(const Node& node) {
    uint32_t most = std::min(node.limit, depth_ ? std::min(most_, 5u) : most_);
    if (out_.bytes.size() >= room_) most = std::min(most, depth_ ? 0u : 1u);
    uint32_t count = random_->below(most + 1);
    // The declared bound itself, if it is small.
    if (node.bound && node.bound == node.limit && node.bound <= 64 && random_->one_in(4))
        count = node.bound;
    // Or the limit.
    if (!depth_ && node.limit <= MOST_ITEMS && random_->one_in(64)) count = node.limit;
    align(4);
    uint32_t wire = count;
    // An empty string of CDR has a NUL or not.
    if (node.is_terminated && (count || random_->one_in(2))) ++wire;
    out_.lengths.push_back({out_.bytes.size(), wire, &node});
    put(wire, 4);
    return wire;
}

void Writer::node(const Node& node) {
    uint32_t count = node.count;
    uint32_t wire = 0;
    switch (node.kind) {
        case Node::Kind::Scalar:
            align(node.bytes);
            number(node.bytes);
            break;
        case Node::Kind::Trigger:
            break;
        case Node::Kind::Run:
            if (node.length_leaf >= 0) wire = length(node);
            if (node.length_leaf >= 0) count = node.is_terminated && wire ? wire - 1 : wire;
            if (count) align(node.bytes);
            for (uint32_t n = 0; n < count; ++n) number(node.bytes);
            if (node.is_terminated && wire) put(0, 1);
            break;
        case Node::Kind::Loop:
            if (node.length_leaf >= 0) count = length(node);
            ++depth_;
            for (uint32_t n = 0; n < count; ++n)
                for (const Node& each : node.body) this->node(each);
            --depth_;
            break;
    }
}

Bytes Damager::damaged(Random& random, Damage& kind) {
    static constexpr Damage KINDS[] = {
        Damage::CutAnywhere, Damage::CutAnywhere, Damage::Splice,   Damage::Flip,   Damage::Flip,
        Damage::Length,      Damage::Length,      Damage::Length,   Damage::Header, Damage::Insert,
        Damage::Erase,       Damage::Trailing,    Damage::Trailing, Damage::Empty,
        Damage::Rubbish};
    kind = KINDS[random.below(sizeof KINDS / sizeof KINDS[0])];
    Written packet = writer_.write(random);
    // Not every packet has a header, or a length.
    while (!damage(random, kind, packet))
        kind = random.one_in(2) ? Damage::CutAnywhere : Damage::Trailing;
    return packet.bytes;
}

// The whole packet is the last of its cuts.
Bytes Damager::cut(uint64_t number) {
    if (number < first_cut_) first_cut_ = victims_ = 0;
    while (victims_ == 0 || number - first_cut_ > victim_.size()) {
        if (victims_) first_cut_ += victim_.size() + 1;
        Random random(Random::mixed(seed_, 0xc07, victims_++));
        victim_ = writer_.write(random).bytes;
    }
    return Bytes(victim_.begin(), victim_.begin() + static_cast<long>(number - first_cut_));
}

bool Damager::damage(Random& random, Damage kind, Written& packet) {
    Bytes& bytes = packet.bytes;
    const uint32_t size = static_cast<uint32_t>(bytes.size());
    switch (kind) {
        case Damage::Cut:
        case Damage::CutAnywhere:
            bytes.resize(random.below(size + 1));
            return true;
        case Damage::Splice: {
            const Bytes other = writer_.write(random).bytes;
            bytes.resize(random.below(size + 1));
            const uint32_t from = random.below(static_cast<uint32_t>(other.size()) + 1);
            bytes.insert(bytes.end(), other.begin() + from, other.end());
            return true;
        }
        case Damage::Flip:
            if (!size) return false;
            for (uint32_t left = 1 + random.below(8); left; --left)
                bytes[random.below(size)] ^= static_cast<uint8_t>(1 << random.below(8));
            return true;
        case Damage::Length:
            return play_with_lengths(random, packet);
        case Damage::Header:
            if (!table_.is_cdr) return false;
            // The other identifiers, or any two bytes.
            bytes[0] = random.one_in(2) ? 0 : random.byte();
            bytes[1] = random.one_in(2) ? random.below(12) : random.byte();
            if (random.one_in(8)) bytes.resize(random.below(HEADER_BYTES + 1));
            return true;
        case Damage::Trailing:
            for (uint32_t left = 1 + random.below(random.one_in(4) ? 150 : 9); left; --left)
                bytes.push_back(random.byte());
            return true;
        case Damage::Empty:
            bytes.clear();
            return true;
        case Damage::Insert:
            bytes.insert(bytes.begin() + random.below(size + 1), random.byte());
            return true;
        case Damage::Erase:
            if (!size) return false;
            bytes.erase(bytes.begin() + random.below(size));
            return true;
        case Damage::Rubbish:
            bytes.resize(random.below(LONGEST_RUBBISH));
            for (uint8_t& each : bytes) each = random.one_in(3) ? 0 : random.byte();
            // A right header lets the rubbish come further.
            if (table_.is_cdr && bytes.size() >= 2) bytes[0] = 0, bytes[1] = 1;
            return true;
    }
    return false;
}

// Replace lengths by other numbers. The packet's bytes stay, or are cut, too.
bool Damager::play_with_lengths(Random& random, Written& packet) {
    if (packet.lengths.empty()) return false;
    const uint32_t lengths = static_cast<uint32_t>(packet.lengths.size());
    const LengthAt& length = packet.lengths[random.below(lengths)];
    replace_length(random, length, packet.bytes);
    // Lengths inside each other claim too much together.
    for (uint32_t left = random.one_in(4) ? 1 + random.below(3) : 0; left; --left)
        replace_length(random, packet.lengths[random.below(lengths)], packet.bytes);
    if (random.one_in(8)) {
        const size_t least = length.at + 4;
        const uint32_t rest = static_cast<uint32_t>(packet.bytes.size() - least);
        packet.bytes.resize(least + random.below(rest + 1));
    }
    return true;
}

// The new number is next to something.
void Damager::replace_length(Random& random, const LengthAt& length, Bytes& bytes) {
    const uint32_t limit = length.node->limit + length.node->is_terminated;
    const uint32_t bound = length.node->bound + length.node->is_terminated;
    const uint32_t numbers[] = {0,     1,         bound,       bound + 1,        limit,
                                limit, limit + 1, 0x80000000u, 0xffffffffu,      length.value - 1,
                                length.value + 1, random.below(limit + 2)};
    put_at(bytes, length.at, numbers[random.below(sizeof numbers / sizeof numbers[0])]);
}
