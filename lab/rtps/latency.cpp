// A node with a GMII in Verilator: frames in and out, with their cycles, and a trace of the signals inside.
//
// latency TRACE, all numbers little-endian. Input: a batch is a number of frames (32 bits), the cycles to run behind
// them (32), and whether they are traced (32); a frame is its size (32), and its bytes from the preamble on. Output:
// a byte 1, a cycle (64), the size (32) and the bytes of a frame that the node began to send in this cycle; a byte 2,
// and the cycle (64) of the last byte of a frame that came; at the end of a batch, a byte 0 and the cycle (64).

#include <cstdint>
#include <vector>

#include "Vnode.h"
#include "pipe.h"
#include "verilated.h"
#include "verilated_vcd_c.h"

namespace {

constexpr int kGap = 12;

Vnode node;
VerilatedVcdC trace;
bool traces = false;
uint64_t cycles = 0, began = 0;
std::vector<uint8_t> sent;

void cycle() {
  node.aclk = 0;
  node.gmii_rx_clk = 1;
  node.eval();
  if (traces) trace.dump(cycles);
  if (node.gmii_tx_en) {
    if (sent.empty()) began = cycles;
    sent.push_back(node.gmii_txd);
  } else if (!sent.empty()) {
    put<uint8_t>(1);
    put(began);
    put<uint32_t>(sent.size());
    std::fwrite(sent.data(), 1, sent.size(), stdout);
    sent.clear();
  }
  node.aclk = 1;
  node.gmii_rx_clk = 0;
  node.eval();
  ++cycles;
}

}  // namespace

int main(int, char** argv) {
  Verilated::traceEverOn(true);
  node.trace(&trace, 99);
  trace.open(argv[1]);
  node.nonce = 1;
  for (int i = 0; i < 64; ++i) cycle();
  node.aresetn = 1;
  for (;;) {
    uint32_t count = get<uint32_t>();
    const uint32_t rest = get<uint32_t>();
    traces = get<uint32_t>();
    for (; count > 0; --count) {
      std::vector<uint8_t> bytes(get<uint32_t>());
      if (std::fread(bytes.data(), 1, bytes.size(), stdin) != bytes.size()) return 1;
      node.gmii_rx_dv = 1;
      for (uint8_t byte : bytes) {
        node.gmii_rxd = byte;
        cycle();
      }
      node.gmii_rx_dv = 0;
      put<uint8_t>(2);
      put<uint64_t>(cycles - 1);
      for (int i = 0; i < kGap; ++i) cycle();
    }
    for (uint32_t i = 0; i < rest; ++i) cycle();
    trace.flush();
    put<uint8_t>(0);
    put(cycles);
    std::fflush(stdout);
  }
}
