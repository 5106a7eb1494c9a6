// The edge to Ethernet in Verilator.
//
// harness frames SEED: send the frames of standard input, and print what comes out.
// harness tap NAME: be a machine behind a TAP device, which has to exist; until it is killed.
//
// A frame of the input is 3 numbers of 16 bits, little-endian: cycles before it, its bytes, and which byte has
// an error (0xFFFF: none); then the bytes, from the preamble on. The node answers each datagram with its CRC-32
// and its size. Output, a line each: "d IP PORT PORT BYTES" for a datagram, "f BYTES" for a frame that was sent,
// "bad ..." for one that is wrong, and at the end "drops ..." in the order of the edge.

#include <fcntl.h>
#include <linux/if.h>
#include <linux/if_tun.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <string>
#include <vector>

#include "Vboard.h"
#include "verilated.h"

namespace {

using Bytes = std::vector<uint8_t>;

constexpr int kDrops = 11, kReset = 64, kLeastFrame = 60, kMostFrame = 1518, kGap = 12;

uint32_t table[256];

uint32_t crc32(const uint8_t* bytes, size_t size) {
  uint32_t crc = ~0u;
  for (size_t i = 0; i < size; ++i) crc = crc >> 8 ^ table[(crc ^ bytes[i]) & 0xFF];
  return ~crc;
}

void print(const char* head, const Bytes& bytes) {
  std::string text(head);
  static const char* digits = "0123456789abcdef";
  for (uint8_t byte : bytes) text += {digits[byte >> 4], digits[byte & 15]};
  std::puts(text.c_str());
}

struct Frame {
  int gap, error;
  Bytes bytes;
};

struct Answer {
  uint32_t to;
  uint16_t to_port, port;
  std::string text;
};

class Board {
 public:
  explicit Board(uint64_t seed) : random_(seed | 1) {}

  bool idle() const { return coming_.empty() && going_.empty() && answers_.empty() && part_.empty(); }
  bool takes() const { return coming_.empty(); }
  void send(Frame frame) {
    gap_ = frame.gap;
    error_ = frame.error;
    place_ = 0;
    coming_.assign(frame.bytes.begin(), frame.bytes.end());
  }
  std::vector<Bytes> sent;
  bool quiet = false;
  uint64_t drops[kDrops] = {};

  void cycle() {
    ++cycles_;
    board.rst = cycles_ <= kReset;
    board.clk = 0;
    board.rx_clk = 1;
    board.eval();
    if (cycles_ > kReset) {
      wire();
      application();
    }
    board.clk = 1;
    board.rx_clk = 0;
    board.eval();
    move();
  }

 private:
  uint32_t random() {
    random_ ^= random_ << 13, random_ ^= random_ >> 7, random_ ^= random_ << 17;
    return random_ >> 16;
  }

  void wire() {
    if (board.tx_en) {
      going_.push_back(board.txd);
    } else if (!going_.empty()) {
      finish();
      going_.clear();
    }
    board.rx_dv = board.rx_er = 0;
    if (gap_ > 0) {
      --gap_;
      board.rxd = random();
    } else if (!coming_.empty()) {
      board.rx_dv = 1;
      board.rx_er = place_++ == error_;
      board.rxd = coming_.front();
      coming_.pop_front();
      if (coming_.empty()) gap_ = kGap;
    }
    for (int i = 0; i < kDrops; ++i) drops[i] += board.drops >> i & 1;
  }

  void finish() {
    size_t start = 0;
    while (start < going_.size() && going_[start] == 0x55) ++start;
    if (start != 7 || going_[start] != 0xD5) return print("bad preamble ", going_);
    Bytes frame(going_.begin() + 8, going_.end());
    if (frame.size() < kLeastFrame + 4 || frame.size() > kMostFrame) return print("bad size ", frame);
    if (crc32(frame.data(), frame.size()) != 0x2144DF1Cu) return print("bad check sequence ", frame);
    frame.resize(frame.size() - 4);
    sent.push_back(frame);
  }

  // Take datagrams with stalls, and answer them. What is set here counts at the next edge.
  void application() {
    board.received_ready = random() % 16 != 0;
    if (!answers_.empty() && !board.sent_valid) board.sent_valid = random() % 8 != 0;
    if (board.sent_valid) {
      const Answer& answer = answers_.front();
      board.sent_data = answer.text[at_];
      board.sent_last = at_ + 1 == answer.text.size();
      board.sent_length = answer.text.size();
      board.sent_ip = answer.to;
      board.sent_to = answer.to_port;
      board.sent_from = answer.port;
    }
    board.eval();
    takes_ = board.sent_valid && board.sent_ready;
    if (board.received_valid && board.received_ready) take();
  }

  void take() {
    part_.push_back(board.received_data);
    if (!board.received_last) return;
    if (part_.size() != board.received_length || board.received_error) print("bad datagram ", part_);
    char text[64];
    std::snprintf(text, sizeof text, "d %08x %u %u ", board.received_ip, board.received_from, board.received_to);
    if (!quiet) print(text, part_);
    std::snprintf(text, sizeof text, "%08x %zu\n", crc32(part_.data(), part_.size()), part_.size());
    if (answers_.size() < 64)
      answers_.push_back({board.received_ip, uint16_t(board.received_from), uint16_t(board.received_to), text});
    part_.clear();
  }

  // After the edge, `sent` has moved.
  void move() {
    if (!takes_) return;
    takes_ = board.sent_valid = false;
    if (++at_ == answers_.front().text.size()) {
      answers_.pop_front();
      at_ = 0;
    }
  }

  Vboard board;
  uint64_t random_, cycles_ = 0;
  std::deque<uint8_t> coming_;
  int gap_ = 0, error_ = -1, place_ = 0;
  Bytes going_, part_;
  std::deque<Answer> answers_;
  size_t at_ = 0;
  bool takes_ = false;
};

int frames(uint64_t seed) {
  Board board(seed);
  uint16_t head[3];
  bool more = true;
  for (int rest = 200000; rest > 0;) {
    if (more && board.takes()) {
      more = std::fread(head, 2, 3, stdin) == 3;
      if (more) {
        Frame frame{head[0], head[2] == 0xFFFF ? -1 : head[2], Bytes(head[1])};
        if (std::fread(frame.bytes.data(), 1, head[1], stdin) != head[1]) return 1;
        board.send(frame);
      }
    }
    // What waits for an answer of ARP takes its time.
    if (!more) --rest;
    board.cycle();
    for (const Bytes& frame : board.sent) print("f ", frame);
    board.sent.clear();
  }
  std::printf("drops");
  for (uint64_t count : board.drops) std::printf(" %llu", (unsigned long long)count);
  std::puts("");
  return 0;
}

int tap(const char* name) {
  int tap = open("/dev/net/tun", O_RDWR | O_NONBLOCK);
  ifreq request{};
  request.ifr_flags = IFF_TAP | IFF_NO_PI;
  std::strncpy(request.ifr_name, name, IFNAMSIZ - 1);
  if (tap < 0 || ioctl(tap, TUNSETIFF, &request) < 0) return std::perror(name), 1;
  Board board(1);
  board.quiet = true;
  std::puts("ready");
  std::fflush(stdout);
  for (uint64_t cycles = 0;; ++cycles) {
    if (cycles > kReset && cycles % 64 == 0 && board.takes()) {
      Bytes frame(kMostFrame);
      ssize_t size = read(tap, frame.data(), frame.size());
      if (size > 0) {
        frame.resize(size < kLeastFrame ? kLeastFrame : size);
        uint32_t check = crc32(frame.data(), frame.size());
        for (int i = 0; i < 4; ++i) frame.push_back(check >> 8 * i & 0xFF);
        frame.insert(frame.begin(), {0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0xD5});
        board.send({kGap, -1, frame});
      } else if (board.idle() && cycles % 16384 == 0) {
        // Without traffic, the board runs in slices, and the processor rests between them.
        pollfd waiting{tap, POLLIN, 0};
        poll(&waiting, 1, 1);
      }
    }
    board.cycle();
    for (const Bytes& frame : board.sent)
      if (write(tap, frame.data(), frame.size()) < 0) std::perror("write");
    board.sent.clear();
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (uint32_t byte = 0; byte < 256; ++byte) {
    uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0);
    table[byte] = crc;
  }
  if (argc == 3 && !std::strcmp(argv[1], "frames")) return frames(std::strtoull(argv[2], nullptr, 10));
  if (argc == 3 && !std::strcmp(argv[1], "tap")) return tap(argv[2]);
  return std::fprintf(stderr, "usage: harness frames SEED | tap NAME\n"), 2;
}
