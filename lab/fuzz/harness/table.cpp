#include "table.h"

#include <sstream>
#include <stdexcept>

namespace {

std::vector<Node> read_nodes(std::istream& text, bool is_nested) {
    std::vector<Node> nodes;
    std::string line;
    while (std::getline(text, line)) {
        std::istringstream words(line);
        std::string kind;
        words >> kind;
        if (kind == "end" && is_nested) return nodes;
        Node node;
        if (kind == "scalar") {
            words >> node.leaf >> node.bytes >> node.is_bool;
        } else if (kind == "trigger") {
            node.kind = Node::Kind::Trigger;
            words >> node.leaf;
        } else if (kind == "run") {
            node.kind = Node::Kind::Run;
            words >> node.length_leaf >> node.leaf >> node.bytes >> node.is_bool;
            words >> node.is_terminated >> node.count >> node.bound >> node.limit;
        } else if (kind == "loop") {
            node.kind = Node::Kind::Loop;
            words >> node.length_leaf >> node.bytes >> node.count >> node.bound >> node.limit;
        } else {
            throw std::runtime_error("the table has a line that is not known: " + line);
        }
        if (!words) throw std::runtime_error("a line of the table is too short: " + line);
        if (node.kind == Node::Kind::Loop) node.body = read_nodes(text, true);
        nodes.push_back(node);
    }
    if (is_nested) throw std::runtime_error("the table ends inside a loop");
    return nodes;
}

}  // namespace

Table read_table(std::istream& text) {
    Table table;
    std::string word;
    size_t leaves = 0;
    text >> word >> table.is_cdr >> table.bus_bytes >> leaves;
    text >> table.room >> table.claim_bytes >> table.saved_bytes;
    if (!text || word != "table") throw std::runtime_error("this is not a table");
    table.leaves.resize(leaves);
    for (Leaf& leaf : table.leaves) text >> leaf.name >> leaf.bits >> leaf.lanes;
    if (!text) throw std::runtime_error("the table has too few leaves");
    std::getline(text, word);
    table.nodes = read_nodes(text, false);
    return table;
}

bool Table::transfers_once() const {
    for (const Node& node : nodes) {
        if (node.kind == Node::Kind::Loop || node.length_leaf >= 0) return false;
        if (node.kind == Node::Kind::Run &&
            node.count > static_cast<uint32_t>(leaves[node.leaf].lanes))
            return false;
    }
    return true;
}
