// The reference decoder: what a packet must cause, by the contract in `docs/reference/streams.md`.
//
// It goes through the packet primitive by primitive. It knows no steps, bus words or layouts.
#pragma once

#include <cstdint>
#include <vector>

#include "table.h"

enum Status {
    OK, TRUNCATED, TRAILING, LENGTH, ENCAPSULATION, STRING, ITEMS,
    FULL = 8, LARGE, OVERRUN,  // of a gate
};

const char* name_of(int status);

struct Transfer {
    int leaf = 0;
    bool is_last = false;  // `items.last`
    uint32_t at = 0;       // of its data in `Expected::words`
};

struct Expected {
    int status = OK;
    std::vector<Transfer> transfers;  // in wire order
    std::vector<uint32_t> words;
    // What a serializer writes if it gets these transfers.
    std::vector<uint8_t> rewritten;
    // Transfers before the error.
    size_t good = 0;
};

class Judge {
public:
    explicit Judge(const Table& table) : table_(table) {}

    void judge(const std::vector<uint8_t>& packet, Expected& expected);

private:
    void header();
    void node(const Node& node);
    void run(const Node& node);
    bool length(const Node& node, uint32_t& count);
    bool may_claim(uint64_t bytes);
    void align(int bytes);
    uint64_t read(int bytes);
    void send(int leaf, uint64_t value);
    void send_items(const Node& node, uint32_t count);
    void fail(Status status);
    void write(uint64_t value, int bytes);

    const Table& table_;
    const std::vector<uint8_t>* packet_ = nullptr;
    Expected* out_ = nullptr;
    size_t position_ = 0;
    int depth_ = 0;          // sequences around the field
    uint64_t claimed_ = 0;  // by the outermost sequence and lengths inside
};
