// The board as a process: Verilator runs the node, and UDP sockets are what lies below it.
//
// board ADDRESS CYCLES PORT...: the node has this IPv4 address and these ports, the first of which
// takes part in the group of discovery. The clock runs at CYCLES per second at most, and as fast as
// the machine can while there is something to do. Ctrl-C, or SIGTERM, ends it,
// and prints the counters that are not 0.
//
// With FAULTS=5 in the environment, 5 of 100 datagrams are lost, 5 come twice, and 5 come after the
// one behind them, in each direction.

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <optional>
#include <vector>

#include "Vnode.h"
#include "verilated.h"

namespace {

constexpr uint32_t kGroup = 0xEFFF0001;
constexpr int kSlice = 1024;
constexpr size_t kMostWaiting = 64;

struct Datagram {
  uint32_t address;
  uint16_t from, to;
  std::vector<uint8_t> bytes;
};

// What a bad network does with datagrams on their way.
class Faults {
 public:
  template <typename Deliver>
  void pass(const Datagram& datagram, Deliver deliver) {
    const int dice = percent_ ? std::rand() % 100 : 100;
    if (dice < percent_) return;
    if (dice >= 2 * percent_ && dice < 3 * percent_ && !late_) {
      late_ = datagram;
      return;
    }
    deliver(datagram);
    if (dice < 2 * percent_) deliver(datagram);
    if (late_) deliver(*late_), late_.reset();
  }

 private:
  const int percent_ = std::getenv("FAULTS") ? std::atoi(std::getenv("FAULTS")) : 0;
  std::optional<Datagram> late_;
};

double seconds() {
  using clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(clock::now().time_since_epoch()).count();
}

int open_socket(uint32_t address, uint16_t port, bool in_group) {
  int made = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK, 0), one = 1, size = 1 << 20;
  setsockopt(made, SOL_SOCKET, SO_REUSEADDR, &one, sizeof one);
  setsockopt(made, SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_port = htons(port);
  here.sin_addr.s_addr = htonl(in_group ? kGroup : address);
  if (bind(made, reinterpret_cast<sockaddr*>(&here), sizeof here)) std::perror("bind"), std::exit(1);
  ip_mreq group{{htonl(kGroup)}, {htonl(address)}};
  if (in_group) setsockopt(made, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group);
  in_addr interface{htonl(address)};
  setsockopt(made, IPPROTO_IP, IP_MULTICAST_IF, &interface, sizeof interface);
  return made;
}

volatile std::sig_atomic_t stopped = 0;

// The outputs of the node that count, as far as they are not 0.
void print_counters(const Vnode& node) {
#define COUNTER(NAME) \
  if (node.NAME) std::printf(#NAME " %llu\n", static_cast<unsigned long long>(node.NAME));
#include "counters.inc"
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return std::fprintf(stderr, "usage: board ADDRESS CYCLES PORT...\n"), 2;
  const uint32_t address = ntohl(inet_addr(argv[1]));
  const double rate = std::atof(argv[2]);
  std::vector<pollfd> sockets;
  std::vector<uint16_t> ports;
  for (int i = 3; i < argc; ++i) {
    ports.push_back(std::atoi(argv[i]));
    sockets.push_back({open_socket(address, ports.back(), i == 3), POLLIN, 0});
  }
  Vnode node;
  std::deque<Datagram> to_node;
  std::vector<uint8_t> from_node;
  Faults coming, going;
  size_t at = 0;
  node.aclk = 0;
  node.aresetn = 0;
  node.udp_tx_ready = 1;
  node.nonce = static_cast<uint32_t>(getpid()) << 16 ^ static_cast<uint32_t>(seconds() * 1e6);
  for (int number : {SIGINT, SIGTERM}) std::signal(number, [](int) { stopped = 1; });
  std::printf("ready\n");
  std::fflush(stdout);
  const double start = seconds();
  uint64_t cycles = 0, idle = 0;
  while (!stopped) {
    const bool rests = idle > 16 * kSlice && cycles > (seconds() - start) * rate;
    if (poll(sockets.data(), sockets.size(), rests ? 1 : 0) > 0) {
      for (size_t i = 0; i < sockets.size(); ++i) {
        static uint8_t buffer[1 << 16];
        sockaddr_in from{};
        socklen_t length = sizeof from;
        while (to_node.size() < kMostWaiting) {
          ssize_t size = recvfrom(sockets[i].fd, buffer, sizeof buffer, 0,
                                  reinterpret_cast<sockaddr*>(&from), &length);
          if (size <= 0) break;
          coming.pass({ntohl(from.sin_addr.s_addr), ntohs(from.sin_port), ports[i],
                       {buffer, buffer + size}},
                      [&](const Datagram& datagram) { to_node.push_back(datagram); });
          idle = 0;
        }
      }
    }
    if (rests && to_node.empty()) continue;
    for (int i = 0; i < kSlice; ++i, ++cycles, ++idle) {
      node.aresetn = cycles > 8;
      const bool comes = node.aresetn && !to_node.empty();
      node.udp_rx_valid = comes;
      if (comes) {
        const Datagram& next = to_node.front();
        node.udp_rx_data = next.bytes[at];
        node.udp_rx_last = at + 1 == next.bytes.size();
        node.udp_rx_length = next.bytes.size();
        node.udp_rx_ip_address = next.address;
        node.udp_rx_src_port = next.from;
        node.udp_rx_dst_port = next.to;
      }
      node.eval();
      if (comes && node.udp_rx_ready) {
        idle = 0;
        if (++at == to_node.front().bytes.size()) to_node.pop_front(), at = 0;
      }
      if (node.udp_tx_valid) {
        idle = 0;
        from_node.push_back(node.udp_tx_data);
        if (node.udp_tx_last) {
          if (from_node.size() != node.udp_tx_length) std::fprintf(stderr, "a wrong length\n");
          const uint16_t port = node.udp_tx_dst_port;
          going.pass({node.udp_tx_ip_address, 0, port, std::move(from_node)}, [&](const Datagram& datagram) {
            sockaddr_in to{};
            to.sin_family = AF_INET;
            to.sin_port = htons(datagram.to);
            to.sin_addr.s_addr = htonl(datagram.address);
            sendto(sockets[1].fd, datagram.bytes.data(), datagram.bytes.size(), 0,
                   reinterpret_cast<sockaddr*>(&to), sizeof to);
          });
          from_node.clear();
        }
      }
      node.aclk = 1;
      node.eval();
      node.aclk = 0;
    }
  }
  print_counters(node);
}
