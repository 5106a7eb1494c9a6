// The driver of a node beside Linux on a Zynq: C++17, header only. See docs/howto/zynq-linux.md of
// firm-hdl. An AXI DMA of Xilinx in direct register mode moves the frames; its registers are those
// of PG021, behind UIO, and its memory is a u-dma-buf.
#ifndef FIRM_HDL_ZYNQ_HPP
#define FIRM_HDL_ZYNQ_HPP

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace firm_hdl {

// A device that cannot be used, or that has stopped. Zynq::reset may help.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Message {
  std::uint16_t topic;
  std::uint32_t tag;                 // Of a request, and of its response; else 0.
  std::vector<std::uint8_t> packet;  // The serialized message with its encapsulation header.
};

namespace detail {

inline std::string text_of(const std::string &path) {
  const int file = open(path.c_str(), O_RDONLY);
  char text[64] = {};
  const auto size = file < 0 ? -1 : read(file, text, sizeof text - 1);
  if (file >= 0) close(file);
  if (size < 0) throw Error("cannot read '" + path + "': " + std::strerror(errno));
  while (*text && text[std::strlen(text) - 1] == '\n') text[std::strlen(text) - 1] = 0;
  return text;
}

inline std::uint64_t number_of(const std::string &path, int base) {
  return std::strtoull(text_of(path).c_str(), nullptr, base);
}

// Memory and registers are accessed in the order of the program, also where caches are coherent.
inline void barrier() {
#if defined(__aarch64__) || defined(__arm__)
  __asm__ volatile("dsb sy" ::: "memory");
#else
  std::atomic_thread_fence(std::memory_order_seq_cst);
#endif
}

// A device, which nobody else can open, and its memory.
class Mapped {
 public:
  Mapped(const std::string &path, std::uint64_t bytes, int flags)
      : size(static_cast<std::size_t>(bytes)) {
    file = open(path.c_str(), O_RDWR | flags);
    if (file < 0) throw Error("cannot open '" + path + "': " + std::strerror(errno));
    std::string why = "'" + path + "' is used by another program";
    if (flock(file, LOCK_EX | LOCK_NB) == 0) {
      memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
      if (memory != MAP_FAILED) return;
      why = "cannot map '" + path + "': " + std::strerror(errno);
    }
    close(file);
    throw Error(why);
  }
  Mapped(Mapped &&other) noexcept
      : file(std::exchange(other.file, -1)), memory(other.memory), size(other.size) {}
  Mapped &operator=(Mapped &&) = delete;
  ~Mapped() {
    if (file < 0) return;
    munmap(memory, size);
    close(file);
  }
  int file;
  void *memory = nullptr;
  std::size_t size;
};

inline std::string folder_of_uio(const std::string &name, const std::string &root) {
  const std::string uios = root + "/sys/class/uio";
  std::string found;
  if (DIR *folder = opendir(uios.c_str())) {
    while (const dirent *each = readdir(folder)) {
      const std::string uio = each->d_name;
      if (uio.rfind("uio", 0) == 0 && (uio == name || text_of(uios + "/" + uio + "/name") == name))
        found = uio;
    }
    closedir(folder);
  }
  if (found.empty()) throw Error("there is no UIO device '" + name + "'");
  return found;
}

}  // namespace detail

// The registers of a device, and its interrupt: "uio0", or the name in the device tree.
class Uio {
 public:
  explicit Uio(const std::string &name, const std::string &root = "")
      : Uio(root + "/sys/class/uio/" + detail::folder_of_uio(name, root), root, 0) {}

  int fd() const { return mapped_.file; }
  std::uint32_t read(unsigned offset) { return registers()[offset / 4]; }
  void write(unsigned offset, std::uint32_t value) { registers()[offset / 4] = value; }
  // Interrupts come once, and then no more until they are enabled again.
  void enable_interrupt() {
    const std::uint32_t one = 1;
    if (::write(fd(), &one, sizeof one) != sizeof one) throw Error(why("has no interrupt"));
  }
  void take_interrupt() {
    std::uint32_t count;
    if (::read(fd(), &count, sizeof count) < 0 && errno != EAGAIN) throw Error(why("is gone"));
  }
  // The width of the length register in the device tree; 0 if it is not there.
  unsigned length_bits() const {
    std::uint8_t cell[4] = {};
    const int file = open((folder_ + "/device/of_node/xlnx,sg-length-width").c_str(), O_RDONLY);
    if (file < 0) return 0;
    const bool is_whole = ::read(file, cell, sizeof cell) == sizeof cell;
    close(file);
    return is_whole ? cell[3] : 0;
  }

 private:
  Uio(const std::string &folder, const std::string &root, int)
      : folder_(folder),
        mapped_(root + "/dev" + folder.substr(folder.rfind('/')),
                detail::number_of(folder + "/maps/map0/size", 0), O_NONBLOCK) {}
  volatile std::uint32_t *registers() {
    return static_cast<volatile std::uint32_t *>(mapped_.memory);
  }
  std::string why(const std::string &what) const {
    return "'" + folder_ + "' " + what + ": " + std::strerror(errno);
  }
  std::string folder_;
  detail::Mapped mapped_;
};

// Memory of a fixed address that both the processor and the DMA access.
class DmaBuffer {
 public:
  explicit DmaBuffer(const std::string &name, const std::string &root = "")
      : folder_(root + "/sys/class/u-dma-buf/" + name + "/"),
        address_(detail::number_of(folder_ + "phys_addr", 0)),
        is_coherent_(detail::number_of(folder_ + "dma_coherent", 0) != 0),
        // With O_SYNC, memory would be uncached, where processors refuse unaligned copies.
        mapped_(root + "/dev/" + name, detail::number_of(folder_ + "size", 10), 0) {}

  std::uint64_t address() const { return address_; }
  std::size_t size() const { return mapped_.size; }
  std::uint8_t *data() { return static_cast<std::uint8_t *>(mapped_.memory); }
  // Hand a part over to the DMA, which writes it or reads it; parts begin and end at 64 bytes.
  void to_device(std::size_t offset, std::size_t size, bool is_written) {
    sync("sync_for_device", offset, size, is_written ? 2 : 1);
  }
  // Take a part back that the DMA has written.
  void to_processor(std::size_t offset, std::size_t size) {
    sync("sync_for_cpu", offset, size, 2);
  }

 private:
  void sync(const char *name, std::size_t offset, std::size_t size, unsigned direction) {
    if (is_coherent_) return;
    char text[32];
    const int bytes = std::snprintf(text, sizeof text, "0x%08zX%08zX", offset,
                                    (size & 0xFFFFFFF0) | direction << 2 | 1);
    const int file = open((folder_ + name).c_str(), O_WRONLY);
    const bool is_done = file >= 0 && ::write(file, text, static_cast<std::size_t>(bytes)) == bytes;
    if (file >= 0) close(file);
    if (!is_done) throw Error("cannot write '" + folder_ + name + "': " + std::strerror(errno));
  }
  std::string folder_;
  std::uint64_t address_;
  bool is_coherent_;
  detail::Mapped mapped_;
};

// A node. Use it from one thread. Its messages come while `receive`, `wait` or `send` is called.
template <class Registers = Uio, class Memory = DmaBuffer>
class Zynq {
 public:
  Zynq(Registers registers, Memory memory, std::uint32_t buffer_bytes)
      : registers_(std::move(registers)),
        memory_(std::move(memory)),
        most_(buffer_bytes),
        part_(aligned(buffer_bytes)) {
    if (memory_.size() < 3 * part_)
      throw Error("the buffer has " + std::to_string(memory_.size()) + " bytes, and " +
                  std::to_string(3 * part_) + " are needed");
    if (memory_.address() % kAlignment)
      throw Error("the address of the buffer is no multiple of 64");
    if (const unsigned bits = registers_.length_bits(); bits && most_ >> bits) throw narrow(bits);
    reset();
  }
  Zynq(const Zynq &) = delete;
  Zynq &operator=(const Zynq &) = delete;
  // The DMA must not write into memory that others may use.
  ~Zynq() {
    try {
      reset_dma();
    } catch (const Error &) {
    }
  }

  // Begin anew, after an Error, too. What was under way is lost.
  void reset() {
    is_sending_ = false;
    starts_ = true;
    fragments_ = 0;
    if (!reset_dma()) throw Error("the reset of the DMA does not end; does its clock run?");
    for (const unsigned at : {kMm2s, kS2mm}) {
      const auto control = registers_.read(at + kControl), status = registers_.read(at + kStatus);
      if ((control & 7) != 2 || !(status & kHalted))
        throw Error("this is no AXI DMA with both channels");
      if (status & kSgIncluded)
        throw Error("the DMA has a scatter-gather engine, which has to be left out");
      registers_.write(at + kControl, kRun | kIoc | kErr);
      if (!clears(at + kStatus, kHalted)) throw Error("a channel of the DMA does not start");
    }
    receive_into(1);
    const auto kept = registers_.read(kS2mm + kLength);
    for (unsigned bits = 8; bits <= 26; ++bits)
      if (most_ >> bits && kept == (most_ & ((1U << bits) - 1))) throw narrow(bits);
  }

  // Send a packet: a serialized message. While the DMA is busy, messages are received.
  void send(std::uint16_t topic, const std::uint8_t *packet, std::size_t size,
            std::uint32_t tag = 0) {
    const std::size_t room = most_ - kHeader;
    const std::size_t frames = size > room ? (size + room - 1) / room : 1;
    if (frames > 1U << 16) throw Error("a packet needs more than 65,536 frames");
    for (std::size_t number = 0; number < frames; ++number) {
      const std::size_t begin = number * room;
      const std::size_t bytes = size - begin < room ? size - begin : room;
      const auto end = Clock::now() + std::chrono::seconds(5);
      while (is_sending_ && !completed(kMm2s)) {
        if (Clock::now() > end) throw Error("the node takes nothing");
        if (!pump()) wait_for_interrupt(kStep);
      }
      std::uint8_t *at = memory_.data();
      at[0] = kVersion;
      at[1] = static_cast<std::uint8_t>((number + 1 == frames) | starts_ << 1);
      put(at + 2, topic, 2);
      put(at + 4, size, 4);
      put(at + 8, tag, 4);
      put(at + 12, sequence_, 2);
      put(at + 14, number, 2);
      if (bytes) std::memcpy(at + kHeader, packet + begin, bytes);
      memory_.to_device(0, aligned(kHeader + bytes), false);
      transfer(kMm2s, 0, static_cast<std::uint32_t>(kHeader + bytes));
      is_sending_ = true;
    }
    ++sequence_;
    starts_ = false;
  }
  void send(std::uint16_t topic, const std::vector<std::uint8_t> &packet, std::uint32_t tag = 0) {
    send(topic, packet.data(), packet.size(), tag);
  }

  // Take the next message that has come, if there is one.
  std::optional<Message> receive() {
    while (came_.empty() && pump()) {
    }
    if (came_.empty()) return std::nullopt;
    Message message = std::move(came_.front());
    came_.pop_front();
    return message;
  }
  // Wait for a message; return whether there is one.
  bool wait(std::chrono::milliseconds time) {
    for (const auto end = Clock::now() + time; came_.empty();) {
      if (pump()) continue;
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
      if (left.count() <= 0) return false;
      wait_for_interrupt(static_cast<int>(left.count()));
    }
    return true;
  }
  // Messages of the node that were lost, by their numbers.
  std::uint64_t lost() const { return lost_; }

  // Send a control message (docs/reference/frame.md), and return the value of its response.
  std::uint32_t control(std::uint8_t operation, std::uint32_t argument, std::uint32_t seconds = 0,
                        std::uint32_t nanoseconds = 0) {
    std::vector<std::uint8_t> packet(16);
    packet[0] = operation;
    put(&packet[4], argument, 4);
    put(&packet[8], seconds, 4);
    put(&packet[12], nanoseconds, 4);
    send(0, packet, ++tag_);
    const auto end = Clock::now() + std::chrono::seconds(5);
    for (std::size_t seen = 0; Clock::now() < end;) {
      for (; seen < came_.size(); ++seen) {
        const Message &each = came_[seen];
        if (each.topic || each.tag != tag_ || each.packet.size() != 16) continue;
        const Message answer = each;
        came_.erase(came_.begin() + static_cast<std::ptrdiff_t>(seen));
        if (answer.packet[1]) throw Error("the node refuses a control message");
        return static_cast<std::uint32_t>(get(&answer.packet[4], 4));
      }
      if (!pump()) wait_for_interrupt(kStep);
    }
    throw Error("the node does not answer");
  }
  // Check that the node is the one of this header.
  void check(std::uint64_t fingerprint) {
    const std::uint64_t low = control(1, 1), found = low | std::uint64_t{control(1, 2)} << 32;
    if (found != fingerprint) throw Error("the node is another one, or an older one");
  }
  void set_time(std::uint32_t seconds, std::uint32_t nanoseconds) {
    control(2, 0, seconds, nanoseconds);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr unsigned kMm2s = 0x00, kS2mm = 0x30;
  static constexpr unsigned kControl = 0x00, kStatus = 0x04, kAddress = 0x18, kLength = 0x28;
  static constexpr std::uint32_t kRun = 1, kReset = 1 << 2, kHalted = 1, kSgIncluded = 1 << 3;
  static constexpr std::uint32_t kIoc = 1 << 12, kErr = 1 << 14, kErrors = 7 << 4;
  static constexpr std::size_t kAlignment = 64, kHeader = 16;
  static constexpr std::uint8_t kVersion = 0xF1;
  static constexpr int kStep = 10;

  static std::size_t aligned(std::size_t size) {
    return (size + kAlignment - 1) / kAlignment * kAlignment;
  }
  static void put(std::uint8_t *at, std::uint64_t value, unsigned bytes) {
    for (; bytes--; value >>= 8) *at++ = static_cast<std::uint8_t>(value);
  }
  static std::uint64_t get(const std::uint8_t *at, unsigned bytes) {
    std::uint64_t value = 0;
    while (bytes--) value = value << 8 | at[bytes];
    return value;
  }
  Error narrow(unsigned bits) const {
    return Error("the DMA has lengths of " + std::to_string(bits) + " bits, and frames have up to " +
                 std::to_string(most_) + " bytes");
  }

  bool clears(unsigned offset, std::uint32_t bit) {
    const auto end = Clock::now() + std::chrono::milliseconds(100);
    while (registers_.read(offset) & bit)
      if (Clock::now() > end) return false;
    return true;
  }
  bool reset_dma() {
    // Of both channels, as either bit does it.
    registers_.write(kMm2s + kControl, kReset);
    return clears(kMm2s + kControl, kReset);
  }
  // The length, which starts a transfer, is written last.
  void transfer(unsigned at, std::size_t offset, std::uint32_t size) {
    const std::uint64_t address = memory_.address() + offset;
    registers_.write(at + kAddress, static_cast<std::uint32_t>(address));
    // Also 0, once another part of the buffer was above 4 GiB: the register keeps its value.
    const auto high = static_cast<std::uint32_t>(address >> 32);
    if (high || has_high_addresses_) {
      registers_.write(at + kAddress + 4, high);
      if (registers_.read(at + kAddress + 4) != high)
        throw Error("the DMA has too few bits for the address of the buffer");
      has_high_addresses_ = true;
    }
    detail::barrier();
    registers_.write(at + kLength, size);
  }
  void receive_into(unsigned part) {
    written_ = part;
    memory_.to_device(part * part_, part_, true);
    transfer(kS2mm, part * part_, most_);
  }
  // Return whether a transfer has completed, once.
  bool completed(unsigned at) {
    const auto status = registers_.read(at + kStatus);
    if (status & (kHalted | kErrors)) {
      std::string why = "the DMA has stopped:";
      const char *const names[] = {" DMAIntErr", " DMASlvErr", " DMADecErr"};
      for (const unsigned each : {kMm2s, kS2mm})
        for (unsigned bit = 0; bit < 3; ++bit)
          if (registers_.read(each + kStatus) >> (4 + bit) & 1)
            why += (each ? " S2MM" : " MM2S") + std::string(names[bit]);
      throw Error(why);
    }
    if (!(status & kIoc)) return false;
    registers_.write(at + kStatus, kIoc);
    detail::barrier();
    return true;
  }
  // Take a frame that has come, after the DMA got the other part; return whether there was one.
  bool pump() {
    if (!completed(kS2mm)) return false;
    const std::size_t length = registers_.read(kS2mm + kLength), start = written_ * part_;
    receive_into(3 - written_);
    const std::size_t size = length < most_ ? length : most_;
    memory_.to_processor(start, aligned(size));
    take(memory_.data() + start, size);
    return true;
  }
  void take(const std::uint8_t *frame, std::size_t size) {
    if (size < kHeader || frame[0] != kVersion) return;
    const auto sequence = static_cast<std::uint16_t>(get(frame + 12, 2));
    const auto number = get(frame + 14, 2), length = get(frame + 4, 4);
    if (number == 0)
      under_way_ = {static_cast<std::uint16_t>(get(frame + 2, 2)),
                    static_cast<std::uint32_t>(get(frame + 8, 4)), {}};
    else if (number != fragments_ || sequence != sequence_under_way_)
      return;
    sequence_under_way_ = sequence;
    fragments_ = number + 1;
    under_way_.packet.insert(under_way_.packet.end(), frame + kHeader, frame + size);
    if (!(frame[1] & 1)) return;
    fragments_ = 0;
    if (under_way_.packet.size() != length) return;
    const auto ahead = static_cast<std::uint16_t>(sequence - expected_);
    if (is_synced_ && !(frame[1] & 2) && ahead <= 64) lost_ += ahead;
    is_synced_ = true;
    expected_ = static_cast<std::uint16_t>(sequence + 1);
    came_.push_back(std::move(under_way_));
  }
  void wait_for_interrupt(int milliseconds) {
    registers_.enable_interrupt();
    pollfd event = {registers_.fd(), POLLIN, 0};
    if (poll(&event, 1, milliseconds) > 0) registers_.take_interrupt();
  }

  Registers registers_;
  Memory memory_;
  std::uint32_t most_;
  std::size_t part_;
  bool is_sending_ = false, starts_ = true, is_synced_ = false, has_high_addresses_ = false;
  unsigned written_ = 1;
  std::uint16_t sequence_ = 0, sequence_under_way_ = 0, expected_ = 0;
  std::uint32_t tag_ = 0;
  std::uint64_t fragments_ = 0, lost_ = 0;
  Message under_way_ = {};
  std::deque<Message> came_;
};

}  // namespace firm_hdl

#endif
