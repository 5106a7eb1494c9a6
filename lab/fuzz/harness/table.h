// The table of a type: its leaves, and its fields in wire order.
//
// Python writes the table from the message model, as text. It knows nothing of layouts, plans and
// circuits: alignment, terminators and the packet's header are rules of the judge.
#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <vector>

struct Leaf {
    std::string name;
    int bits = 0;   // of a scalar, or of an item
    int lanes = 1;  // items in a transfer

    // 32-bit words of the data of a transfer.
    int words() const { return (bits * lanes + 31) / 32; }
};

struct Node {
    enum class Kind { Scalar, Trigger, Run, Loop };

    Kind kind = Kind::Scalar;
    int length_leaf = -1;  // of a run or a loop that a length counts, else -1
    int leaf = -1;         // of the scalar, the trigger or the items
    int bytes = 0;         // of the scalar or of an item; of a loop: least, of an element
    bool is_bool = false;
    bool is_terminated = false;  // a NUL follows the items, and the length counts it
    uint32_t count = 0;          // without a length: the number of items or elements
    uint32_t bound = 0;          // that the definition declares, or 0
    uint32_t limit = 0;          // largest length that is no error
    std::vector<Node> body;      // of a loop: the fields of an element
};

struct Table {
    bool is_cdr = false;
    int bus_bytes = 0;
    uint64_t room = 0;         // bytes that nested lengths may claim together
    uint64_t claim_bytes = 0;  // a length whose items have fewer is not counted
    uint64_t saved_bytes = 0;  // of the items of a counted length that it does not claim
    std::vector<Leaf> leaves;
    std::vector<Node> nodes;

    // Each leaf transfers exactly once per message.
    bool transfers_once() const;
};

// Throws std::runtime_error if the text is not a table.
Table read_table(std::istream& text);
