// Times Fast CDR with one message type, which message.h has: a generated file.
//
// Usage: fastcdr_timing PACKETS RUNS SECONDS. PACKETS is a file with packets, each after its length
// in 4 bytes, little-endian. Prints the version of Fast CDR, that of the compiler, and the processor
// time of one message in ns, read and written: the fastest of so many runs, each of so many seconds
// or more. If a packet is not what is written of it, it prints both, and ends with status 1.
#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

namespace {

void check_bound(size_t size, size_t bound) {
  if (size > bound) {throw std::length_error("sequence exceeds its bound");}
}

// As the type support of ROS 2 humble has it, through a std::wstring.
inline void write_wide(Cdr & cdr, const std::u16string & text) {
  cdr << std::wstring(text.begin(), text.end());
}

inline void read_wide(Cdr & cdr, std::u16string & text) {
  std::wstring wide;
  cdr >> wide;
  text.assign(wide.begin(), wide.end());
}

#include "message.h"

using Packet = std::vector<char>;

// Nothing of the memory behind a pointer may be left out as if nobody read it.
inline void used(const void * what) {asm volatile("" : : "r"(what) : "memory");}

void deserialize(Packet & packet, Root & message) {
  FastBuffer buffer(packet.data(), packet.size());
  Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
  cdr.read_encapsulation();
  read(cdr, message);
}

size_t serialize(const Root & message, Packet & packet) {
  FastBuffer buffer(packet.data(), packet.size());
  Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  write(cdr, message);
  return cdr.getSerializedDataLength();
}

std::vector<Packet> packets_in(const char * name) {
  std::vector<Packet> found;
  std::ifstream file(name, std::ios::binary);
  for (uint32_t size; file.read(reinterpret_cast<char *>(&size), sizeof(size)); ) {
    found.emplace_back(size);
    file.read(found.back().data(), size);
  }
  return found;
}

void print_hex(const char * what, const Packet & packet, size_t size) {
  std::printf("%s", what);
  for (size_t at = 0; at < size; ++at) {
    std::printf(" %02x", static_cast<unsigned>(static_cast<unsigned char>(packet[at])));
  }
  std::printf("\n");
}

bool round_trips(std::vector<Packet> & packets) {
  Root message;
  for (Packet & packet : packets) {
    // Fast CDR leaves padding as it is in the buffer.
    Packet written(packet.size() + 64, '\0');
    deserialize(packet, message);
    const size_t size = serialize(message, written);
    if (size != packet.size() || std::memcmp(packet.data(), written.data(), size) != 0) {
      print_hex("read:   ", packet, packet.size());
      print_hex("written:", written, size);
      return false;
    }
  }
  return true;
}

double processor_seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template<typename Work>
double best_ns(size_t items, int runs, double least, Work work) {
  const auto seconds = [&](uint64_t passes) {
      const double start = processor_seconds();
      for (uint64_t pass = 0; pass < passes; ++pass) {
        for (size_t item = 0; item < items; ++item) {work(item);}
      }
      return processor_seconds() - start;
    };
  uint64_t passes = 1;
  double best = seconds(passes);
  for (; best < least; best = seconds(passes)) {passes *= 2;}
  for (int run = 1; run < runs; ++run) {best = std::min(best, seconds(passes));}
  return 1e9 * best / static_cast<double>(passes * items);
}

int time_packets(std::vector<Packet> & packets, int runs, double least) {
  if (packets.empty() || !round_trips(packets)) {return 1;}
  std::vector<Root> messages(packets.size());
  size_t largest = 0;
  for (size_t item = 0; item < packets.size(); ++item) {
    deserialize(packets[item], messages[item]);
    largest = std::max(largest, packets[item].size());
  }
  // One message and one buffer for all, as a node has that uses them again.
  Root message;
  const double reading = best_ns(packets.size(), runs, least, [&](size_t item) {
      deserialize(packets[item], message);
      used(&message);
    });
  Packet buffer(largest);
  const double writing = best_ns(packets.size(), runs, least, [&](size_t item) {
      serialize(messages[item], buffer);
      used(buffer.data());
    });
  std::printf("%s\n%s\n%.2f\n%.2f\n", FASTCDR_VERSION_STR, __VERSION__, reading, writing);
  return 0;
}

}  // namespace

int main(int count, char ** arguments) {
  if (count != 4) {return 2;}
  std::vector<Packet> packets = packets_in(arguments[1]);
  try {
    return time_packets(packets, std::atoi(arguments[2]), std::atof(arguments[3]));
  } catch (const eprosima::fastcdr::exception::Exception & error) {
    std::printf("Fast CDR refuses a packet: %s\n", error.what());
  } catch (const std::exception & error) {
    std::printf("a packet is refused: %s\n", error.what());
  }
  return 1;
}
