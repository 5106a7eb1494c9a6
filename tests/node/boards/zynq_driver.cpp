// The driver in C++ against the chip of tests/node/boards/chip.py, or against files as devices.
#include <sys/socket.h>
#include <sys/un.h>

#include <cstdio>

#include "echo_zynq.hpp"

namespace {

struct Wire {
  explicit Wire(const std::string &folder) : file(socket(AF_UNIX, SOCK_SEQPACKET, 0)) {
    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    std::snprintf(address.sun_path, sizeof address.sun_path, "%s/chip", folder.c_str());
    if (connect(file, reinterpret_cast<const sockaddr *>(&address), sizeof address))
      throw firm_hdl::Error("no chip");
  }
  std::uint32_t call(char op, std::size_t a = 0, std::size_t b = 0) const {
    std::uint8_t order[9] = {static_cast<std::uint8_t>(op)};
    for (unsigned n = 0; n < 4; ++n) {
      order[1 + n] = static_cast<std::uint8_t>(a >> 8 * n);
      order[5 + n] = static_cast<std::uint8_t>(b >> 8 * n);
    }
    std::uint32_t value = 0;
    if (send(file, order, sizeof order, 0) != sizeof order ||
        recv(file, &value, sizeof value, 0) != sizeof value)
      throw firm_hdl::Error("the chip is gone");
    return value;
  }
  int file;
};

struct Registers {
  explicit Registers(const std::string &folder) : wire(folder), interrupts(folder) {
    interrupts.call('i');
  }
  int fd() const { return interrupts.file; }
  std::uint32_t read(unsigned offset) const { return wire.call('r', offset); }
  void write(unsigned offset, std::uint32_t value) const { wire.call('w', offset, value); }
  void enable_interrupt() const { wire.call('e'); }
  void take_interrupt() const {
    std::uint32_t count;
    recv(interrupts.file, &count, sizeof count, MSG_DONTWAIT);
  }
  unsigned length_bits() const { return wire.call('p'); }
  Wire wire, interrupts;
};

struct Memory {
  explicit Memory(const std::string &folder) : wire(folder), mapped(folder + "/memory", 1 << 18, 0) {}
  std::uint64_t address() const { return 0x130000000; }
  std::size_t size() const { return mapped.size; }
  std::uint8_t *data() { return static_cast<std::uint8_t *>(mapped.memory); }
  void to_device(std::size_t offset, std::size_t size, bool is_written) const {
    wire.call(is_written ? 'D' : 'd', offset, size);
  }
  void to_processor(std::size_t offset, std::size_t size) const { wire.call('c', offset, size); }
  Wire wire;
  firm_hdl::detail::Mapped mapped;
};

std::vector<std::uint8_t> packet_of(std::size_t number) {
  std::vector<std::uint8_t> packet(number * 37 % 1500);
  for (auto &each : packet) each = static_cast<std::uint8_t>(number++);
  return packet;
}

void talk(const std::string &folder) {
  namespace echo = echo_node;
  firm_hdl::Zynq<Registers, Memory> board(Registers{folder}, Memory{folder}, echo::buffer_bytes);
  board.check(echo::fingerprint);
  board.set_time(7, 0);
  std::size_t right = 0;
  for (std::size_t n = 0; n < 100; ++n) {
    board.send(echo::topic_heard, packet_of(n));
    while (n % 10 == 9 && board.wait(std::chrono::seconds(20))) {
      const auto message = board.receive();
      right += message->topic == echo::topic_said && message->packet == packet_of(right);
      if (right == n + 1) break;
    }
  }
  std::printf("%zu right, %llu lost\n", right, static_cast<unsigned long long>(board.lost()));
  board.send(echo::topic_cal, packet_of(3), 77);
  board.wait(std::chrono::seconds(20));
  const auto answer = board.receive();
  std::printf("answer %u: %d\n", answer->tag, answer->packet == packet_of(3));
  for (const char *each : {"MM2S", "S2MM", "long"}) {
    // Upon this, the next transfer fails.
    try {
      board.send(echo::topic_heard, std::vector<std::uint8_t>(each, each + 4));
      board.control(1, 0);
      board.control(1, 0);
    } catch (const firm_hdl::Error &error) {
      std::printf("%s\n", error.what());
    }
    board.reset();
    while (board.receive()) {
    }
    board.check(echo::fingerprint);
  }
}

}  // namespace

int main(int, char **values) {
  try {
    if (std::string(values[1]) == "chip") {
      talk(values[2]);
      return 0;
    }
    firm_hdl::Uio uio("dma", values[2]);
    uio.write(0x34, 0x12345678);
    firm_hdl::DmaBuffer buffer("udmabuf0", values[2]);
    buffer.data()[64] = 'a';
    buffer.to_device(64, 128, false);
    buffer.to_processor(256, 256);
    std::printf("%x %u %zu %llx\n", uio.read(0x34), uio.length_bits(), buffer.size(),
                static_cast<unsigned long long>(buffer.address()));
    firm_hdl::Zynq<> board(std::move(uio), std::move(buffer), 256);
  } catch (const firm_hdl::Error &error) {
    std::printf("%s\n", error.what());
  }
}
