// The board as a process: Verilator runs it, and Linux sees it as a machine behind a TAP device.
//
// board TAP: join the network of a TAP device, which has to exist. Ctrl-C, or SIGTERM, ends it, and
// prints the counters that are not 0.
//
// What is simulated begins at the pins of a PHY. The PHY's clock is that of the node, half a cycle later.

#include <fcntl.h>
#include <linux/if.h>
#include <linux/if_tun.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <deque>
#include <string>
#include <vector>

#include "Vboard.h"
#include "verilated.h"

namespace {

constexpr int kMostFrame = 1518, kLeastFrame = 60, kGap = 12, kReset = 64;

uint32_t crc32(const std::vector<uint8_t>& bytes) {
  uint32_t crc = ~0u;
  for (uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0);
  }
  return ~crc;
}

int open_tap(const char* name) {
  int tap = open("/dev/net/tun", O_RDWR | O_NONBLOCK);
  ifreq request{};
  request.ifr_flags = IFF_TAP | IFF_NO_PI;
  std::strncpy(request.ifr_name, name, IFNAMSIZ - 1);
  if (tap < 0 || ioctl(tap, TUNSETIFF, &request) < 0) {
    std::perror(name);
    return -1;
  }
  return tap;
}

// Ethernet at the GMII: preamble, frame, frame check sequence, gap.
class Wire {
 public:
  Wire(Vboard& board, int tap) : board_(board), tap_(tap) {}

  bool idle() const { return to_board_.empty() && from_board_.empty(); }

  // Take a frame from the TAP device, if the one before it has been sent.
  bool fetch() {
    if (!to_board_.empty() || gap_ > 0) return false;
    std::vector<uint8_t> frame(kMostFrame);
    ssize_t size = read(tap_, frame.data(), frame.size());
    if (size <= 0) return false;
    frame.resize(size < kLeastFrame ? kLeastFrame : size);
    uint32_t check = crc32(frame);
    for (int i = 0; i < 4; ++i) frame.push_back(check >> 8 * i & 0xFF);
    to_board_.assign(7, 0x55);
    to_board_.push_back(0xD5);
    to_board_.insert(to_board_.end(), frame.begin(), frame.end());
    return true;
  }

  // Set the inputs of the next cycle, and take the outputs of this one.
  void cycle() {
    if (board_.gmii_tx_en) {
      from_board_.push_back(board_.gmii_txd);
    } else if (!from_board_.empty()) {
      deliver();
      from_board_.clear();
    }
    board_.gmii_rx_dv = !to_board_.empty();
    if (board_.gmii_rx_dv) {
      board_.gmii_rxd = to_board_.front();
      to_board_.pop_front();
      gap_ = kGap;
    } else if (gap_ > 0) {
      --gap_;
    }
  }

 private:
  void deliver() {
    size_t start = 0;
    while (start < from_board_.size() && from_board_[start] == 0x55) ++start;
    if (start == from_board_.size() || from_board_[start] != 0xD5) return wrong("preamble");
    std::vector<uint8_t> frame(from_board_.begin() + start + 1, from_board_.end());
    if (frame.size() < kLeastFrame + 4) return wrong("size");
    if (crc32(frame) != 0x2144DF1Cu) return wrong("frame check sequence");
    if (write(tap_, frame.data(), frame.size() - 4) < 0) std::perror("write");
  }

  void wrong(const char* what) { std::fprintf(stderr, "a frame of the board has a wrong %s\n", what); }

  Vboard& board_;
  int tap_, gap_ = 0;
  std::deque<uint8_t> to_board_;
  std::vector<uint8_t> from_board_;
};

volatile std::sig_atomic_t stopped = 0;

// The outputs of the node that count, as far as they are not 0.
void print_counters(const Vboard& node) {
#define COUNTER(NAME) \
  if (node.NAME) std::printf(#NAME " %llu\n", static_cast<unsigned long long>(node.NAME));
#include "counters.inc"
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: board TAP\n"), 2;
  int tap = open_tap(argv[1]);
  if (tap < 0) return 1;
  Vboard board;
  Wire wire(board, tap);
  for (int number : {SIGINT, SIGTERM}) std::signal(number, [](int) { stopped = 1; });
  std::printf("ready\n");
  std::fflush(stdout);
  for (uint64_t cycles = 0; !stopped; ++cycles) {
    // Without traffic, the board runs in slices, and the processor rests between them.
    if (cycles > kReset && cycles % 256 == 0 && !wire.fetch() && wire.idle() && cycles % 16384 == 0) {
      pollfd waiting{tap, POLLIN, 0};
      poll(&waiting, 1, 1);
    }
    board.aresetn = cycles > kReset;
    board.aclk = 0;
    board.gmii_rx_clk = 1;
    board.eval();
    wire.cycle();
    board.aclk = 1;
    board.gmii_rx_clk = 0;
    board.eval();
  }
  print_counters(board);
}
