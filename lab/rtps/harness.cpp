// A node with `link: rtps` in Verilator. Datagrams come from standard input, and go to standard output.
//
// Input, all numbers little-endian: a batch is a number of datagrams (32 bits) and the cycles to run after the
// last of them (32 bits); a datagram is an address (32), its two ports (16 each), its size (16), and bytes.
// Output: for each datagram that the node sent, a byte 1, the address (32), the port (16), the size (16), and bytes;
// at the end of a batch, a byte 0 and the cycles since the start (64). A byte 2 in its place: the node has not
// taken a byte for a long time.

#include <cstdint>
#include <vector>

#include "Vnode.h"
#include "pipe.h"
#include "verilated.h"

namespace {

constexpr uint32_t kLongest = 1'000'000;

Vnode node;
uint64_t cycles = 0, random_state;
std::vector<uint8_t> sent;

uint32_t random_number() {
  random_state ^= random_state << 13, random_state ^= random_state >> 7, random_state ^= random_state << 17;
  return random_state >> 16;
}

// Run a cycle, and return whether the node took the byte that is offered.
bool cycle() {
  node.aclk = 0;
  node.udp_tx_ready = random_number() % 8 != 0;
  node.eval();
  const bool takes = node.udp_rx_valid && node.udp_rx_ready;
  if (node.udp_tx_valid && node.udp_tx_ready) {
    sent.push_back(node.udp_tx_data);
    if (node.udp_tx_last) {
      put<uint8_t>(sent.size() == node.udp_tx_length ? 1 : 3);
      put<uint32_t>(node.udp_tx_ip_address);
      put<uint16_t>(node.udp_tx_dst_port);
      put<uint16_t>(sent.size());
      std::fwrite(sent.data(), 1, sent.size(), stdout);
      sent.clear();
    }
  }
  node.aclk = 1;
  node.eval();
  ++cycles;
  return takes;
}

bool offer(const std::vector<uint8_t>& bytes) {
  for (size_t at = 0; at < bytes.size(); ++at) {
    node.udp_rx_valid = 0;
    while (random_number() % 16 == 0) cycle();
    node.udp_rx_valid = 1;
    node.udp_rx_data = bytes[at];
    node.udp_rx_last = at + 1 == bytes.size();
    uint32_t waited = 0;
    while (!cycle())
      if (++waited == kLongest) return false;
  }
  node.udp_rx_valid = 0;
  return true;
}

}  // namespace

int main(int, char** argv) {
  random_state = std::strtoull(argv[1], nullptr, 10) | 1;
  node.nonce = random_state;
  node.aresetn = 0;
  for (int i = 0; i < 8; ++i) cycle();
  node.aresetn = 1;
  for (;;) {
    uint32_t count = get<uint32_t>();
    const uint32_t rest = get<uint32_t>();
    for (bool runs = true; count > 0; --count) {
      node.udp_rx_ip_address = get<uint32_t>();
      node.udp_rx_src_port = get<uint16_t>();
      node.udp_rx_dst_port = get<uint16_t>();
      std::vector<uint8_t> bytes(get<uint16_t>());
      node.udp_rx_length = bytes.size();
      if (std::fread(bytes.data(), 1, bytes.size(), stdin) != bytes.size()) return 1;
      runs = runs && offer(bytes);
      if (!runs) {
        put<uint8_t>(2);
        return 0;
      }
    }
    for (uint32_t i = 0; i < rest; ++i) cycle();
    put<uint8_t>(0);
    put<uint64_t>(cycles);
    std::fflush(stdout);
  }
}
