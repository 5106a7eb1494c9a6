#include "judge.h"

#include <algorithm>

namespace {

constexpr int HEADER_BYTES = 4;
constexpr size_t MOST_TRAILING = 3;

}  // namespace

const char* name_of(int status) {
    static const char* const NAMES[] = {"OK",     "TRUNCATED", "TRAILING", "LENGTH",
                                        "ENCAPSULATION", "STRING",    "ITEMS",    "7",
                                        "FULL",   "LARGE",     "OVERRUN"};
    return status >= 0 && status <= OVERRUN ? NAMES[status] : "an unknown code";
}

void Judge::judge(const std::vector<uint8_t>& packet, Expected& expected) {
    packet_ = &packet;
    out_ = &expected;
    position_ = 0;
    depth_ = 0;
    expected.status = OK;
    expected.transfers.clear();
    expected.words.clear();
    expected.rewritten.clear();
    if (table_.is_cdr) header();
    for (const Node& each : table_.nodes) node(each);
    if (out_->status != OK) return;
    out_->good = out_->transfers.size();
    const size_t rest = packet.size() - position_;
    if (rest > (table_.is_cdr ? MOST_TRAILING : 0)) out_->status = TRAILING;
}

// Only the first error counts.
void Judge::fail(Status status) {
    if (out_->status != OK) return;
    out_->status = status;
    out_->good = out_->transfers.size();
}

// The identifier is judged byte by byte; the two bytes of options are ignored.
void Judge::header() {
    for (int at = 0; at < HEADER_BYTES && out_->status == OK; ++at) {
        if (packet_->size() <= static_cast<size_t>(at))
            fail(TRUNCATED);
        else if (at < 2 && (*packet_)[at] != at)
            fail(ENCAPSULATION);
    }
    position_ = HEADER_BYTES;
    for (int at = 0; at < HEADER_BYTES; ++at) out_->rewritten.push_back(at == 1);
}

// A primitive of CDR starts at a multiple of its size, counted from the end of the header.
void Judge::align(int bytes) {
    if (!table_.is_cdr) return;
    position_ += (0 - (position_ - HEADER_BYTES)) % bytes;
    while ((out_->rewritten.size() - HEADER_BYTES) % bytes) out_->rewritten.push_back(0);
}

// Return a primitive's bits; 0 if it is not there, or after an error.
uint64_t Judge::read(int bytes) {
    if (out_->status != OK) return 0;
    if (position_ + bytes > packet_->size()) {
        fail(TRUNCATED);
        return 0;
    }
    uint64_t value = 0;
    for (int n = 0; n < bytes; ++n)
        value |= static_cast<uint64_t>((*packet_)[position_ + n]) << (8 * n);
    position_ += bytes;
    return value;
}

void Judge::write(uint64_t value, int bytes) {
    for (int n = 0; n < bytes; ++n) out_->rewritten.push_back(static_cast<uint8_t>(value >> 8 * n));
}

void Judge::send(int leaf, uint64_t value) {
    out_->transfers.push_back({leaf, false, static_cast<uint32_t>(out_->words.size())});
    for (int n = 0; n < table_.leaves[leaf].words(); ++n)
        out_->words.push_back(static_cast<uint32_t>(value >> 32 * n));
}

void Judge::node(const Node& node) {
    switch (node.kind) {
        case Node::Kind::Scalar: {
            align(node.bytes);
            uint64_t value = read(node.bytes);
            if (node.is_bool) value = value != 0;
            send(node.leaf, value);
            write(value, node.bytes);
            break;
        }
        case Node::Kind::Trigger:
            send(node.leaf, 1);
            break;
        case Node::Kind::Run:
            run(node);
            break;
        case Node::Kind::Loop: {
            uint32_t count = node.count;
            if (node.length_leaf >= 0) length(node, count);
            depth_ += node.length_leaf >= 0;
            for (uint32_t n = 0; n < count; ++n)
                for (const Node& each : node.body) this->node(each);
            depth_ -= node.length_leaf >= 0;
            break;
        }
    }
}

// Judge a length, and send it. Return whether a NUL follows the items.
bool Judge::length(const Node& node, uint32_t& count) {
    align(4);
    uint32_t wire = static_cast<uint32_t>(read(4));
    count = node.is_terminated && wire ? wire - 1 : wire;
    if (count > node.limit || !may_claim(uint64_t{wire} * node.bytes)) {
        fail(LENGTH);
        wire = count = 0;
    }
    send(node.length_leaf, count);
    // A serializer terminates an empty string, too.
    write(count + node.is_terminated, 4);
    return node.is_terminated && wire > 0;
}

// A sequence and all lengths inside claim no more bytes together than a packet has for them.
bool Judge::may_claim(uint64_t bytes) {
    if (!depth_) claimed_ = 0;
    if (bytes < table_.claim_bytes) return true;
    claimed_ += bytes - table_.saved_bytes;
    return claimed_ <= table_.room;
}

void Judge::run(const Node& node) {
    uint32_t count = node.count;
    const bool has_nul = node.length_leaf >= 0 && length(node, count);
    if (count) align(node.bytes);
    send_items(node, count);
    if (node.is_terminated) write(0, 1);
    // `read` is 0 after an error.
    if (has_nul && read(1) != 0) fail(STRING);
}

void Judge::send_items(const Node& node, uint32_t count) {
    const Leaf& leaf = table_.leaves[node.leaf];
    for (uint32_t first = 0; first < count; first += leaf.lanes) {
        const uint32_t at = static_cast<uint32_t>(out_->words.size());
        const uint32_t filled = std::min<uint32_t>(leaf.lanes, count - first);
        out_->words.resize(at + leaf.words());
        for (uint32_t lane = 0; lane < filled; ++lane) {
            uint64_t value = read(node.bytes);
            if (node.is_bool) value = value != 0;
            write(value, node.bytes);
            const uint32_t bit = lane * leaf.bits;
            out_->words[at + bit / 32] |= static_cast<uint32_t>(value << bit % 32);
            if (leaf.bits == 64)
                out_->words[at + bit / 32 + 1] = static_cast<uint32_t>(value >> 32);
        }
        out_->transfers.push_back({node.leaf, first + leaf.lanes >= count, at});
    }
}
