// Simulates a design that Verilator has translated, by the messages of `protocol.py` on a socket.
//
// A step begins when the inputs have been applied and all signals have settled. Then transfers are
// sampled on the streams whose clocks have an edge, these clocks rise, and the inputs of the next step
// are applied with the falling clocks. With one clock, a step is a cycle.
#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

namespace firm_hdl {

using Bytes = std::vector<uint8_t>;

// A port of the design. Verilator keeps it in a number of 8 to 64 bits, or an array of words of 32
// bits; the machine is little-endian, as the protocol is. Bits above the port's are 0.
template <typename Port>
uint8_t* bytes_of(Port& port) {
    return reinterpret_cast<uint8_t*>(&port);
}

enum Order : uint8_t { SEND = 1, SET, GET, STALL, RUN, LIVE, HALT, RESET, CLOCKS };
enum Answer : uint8_t { TRANSFERS = 1, VALUES, DONE };
enum class Reason : uint8_t { Cycles, Quiet, Conditions, Halted };

constexpr uint16_t ALL_TRANSFERS = 0xffff;
// Steps between two looks at the socket.
constexpr uint64_t BURST = 64;
// Bytes of transfers that are sent before a run ends.
constexpr size_t FLUSH_BYTES = 1 << 16;
constexpr int PARENT_MILLISECONDS = 500;

template <typename Number>
void put(Bytes& bytes, Number number) {
    for (size_t n = 0; n < sizeof number; ++n)
        bytes.push_back(static_cast<uint8_t>(static_cast<uint64_t>(number) >> 8 * n));
}

// Reads numbers from the body of a message.
struct Reader {
    const uint8_t* at;
    const uint8_t* end;

    template <typename Number>
    Number take() {
        uint64_t number = 0;
        for (size_t n = 0; n < sizeof(Number); ++n) number |= uint64_t(*at++) << 8 * n;
        return static_cast<Number>(number);
    }
};

struct Clock {
    uint8_t* signal;
    // Its value at an edge.
    uint8_t active;
    // The time between two edges, and that of the next one.
    uint64_t period = 1, next = 1;
    // Edges, and those since the last transfer.
    uint64_t cycle = 0, quiet = 0;
};

struct Stalls {
    std::vector<bool> pattern;

    bool at(const Clock& clock) const {
        return !pattern.empty() && pattern[clock.cycle % pattern.size()];
    }
};

struct Stream {
    bool is_input;
    // `ready` of an output, `valid` of an input: what the outside drives. Null: it is constant.
    uint8_t* valid;
    uint8_t* ready;
    uint8_t* payload;
    size_t bytes;
    size_t clock;

    Stalls stalls;
    bool is_offered = false;
    // Payloads that were not yet taken, from `first` on.
    Bytes queue;
    size_t first = 0;
    // Transfers that were not yet sent.
    Bytes records;

    uint64_t queued() const { return (queue.size() - first) / bytes; }

    void apply(const Clock& clock) {
        if (!is_input) {
            if (ready) *ready = !stalls.at(clock);
            return;
        }
        if (!is_offered && first < queue.size() && !stalls.at(clock)) {
            std::memcpy(payload, &queue[first], bytes);
            is_offered = true;
        }
        *valid = is_offered;
    }

    void taken() {
        is_offered = false;
        first += bytes;
        if (first == queue.size()) {
            queue.clear();
            first = 0;
        } else if (first >= FLUSH_BYTES && 2 * first >= queue.size()) {
            queue.erase(queue.begin(), queue.begin() + static_cast<std::ptrdiff_t>(first));
            first = 0;
        }
    }
};

struct Plain {
    uint8_t* value;
    size_t bytes;
};

struct Condition {
    Stream* stream;
    uint16_t bit;
    uint64_t count;

    void note(const Stream& moved) {
        if (&moved != stream || !count) return;
        if (bit == ALL_TRANSFERS || stream->payload[bit / 8] >> bit % 8 & 1) --count;
    }
};

// What `model.cc` fills in: the ports of a design.
struct Ports {
    std::vector<Clock> clocks;
    std::vector<Stream> streams;
    std::vector<Plain> inputs, outputs;
};

template <typename Design>
class Server {
  public:
    // `begun` is called with each new design, and `moved` at half steps, for a waveform.
    Server(int socket, int parent, void (*connect)(Design&, Ports&),
           void (*begun)(Design&) = nullptr, void (*moved)(uint64_t) = nullptr)
        : socket(socket), parent(parent), connect(connect), begun(begun), moved_to(moved) {
        start();
    }

    // Serves messages until the other side closes the socket.
    void serve() {
        while (true) {
            bool is_active = is_live && !is_quiet(live_quiet);
            if (is_live) run_burst(is_active ? BURST : 0);
            receive(is_active ? 0 : is_live ? live_milliseconds : PARENT_MILLISECONDS);
        }
    }

  private:
    void start() {
        design.reset(new Design);
        ports = Ports();
        connect(*design, ports);
        if (begun) begun(*design);
        half_steps = 0;
        for (size_t n = 0; n < periods.size(); ++n)
            ports.clocks[n].period = ports.clocks[n].next = periods[n];
        // Not yet settled.
        is_applied = false;
    }

    void reset() {
        Ports before = std::move(ports);
        start();
        for (size_t n = 0; n < ports.streams.size(); ++n)
            ports.streams[n].stalls = before.streams[n].stalls;
        for (size_t n = 0; n < set_values.size(); ++n)
            if (!set_values[n].empty())
                std::memcpy(ports.inputs[n].value, set_values[n].data(), set_values[n].size());
    }

    void apply() {
        if (is_applied) return;
        for (Stream& stream : ports.streams) stream.apply(ports.clocks[stream.clock]);
        for (Clock& clock : ports.clocks) *clock.signal = !clock.active;
        design->eval();
        is_applied = true;
    }

    // Simulates the rest of a step whose inputs have been applied.
    void finish_step() {
        uint64_t now = UINT64_MAX;
        for (const Clock& clock : ports.clocks) now = std::min(now, clock.next);
        bool moved = false;
        for (Stream& stream : ports.streams) {
            if (stream.is_input ? !stream.is_offered : !(*stream.valid & 1)) continue;
            if (stream.ready && !(*stream.ready & 1)) continue;
            if (ports.clocks[stream.clock].next != now) continue;
            moved = true;
            for (Condition& condition : conditions) condition.note(stream);
            if (stream.is_input)
                stream.taken();
            else
                record(stream);
        }
        if (moved) be_active();
        if (moved_to) moved_to(half_steps++);
        for (Clock& clock : ports.clocks)
            if (clock.next == now) *clock.signal = clock.active;
        design->eval();
        if (moved_to) moved_to(half_steps++);
        for (Clock& clock : ports.clocks) {
            if (clock.next != now) continue;
            clock.next += clock.period;
            ++clock.cycle;
            clock.quiet += !moved;
        }
        is_applied = false;
    }

    void record(Stream& stream) {
        uint64_t cycle = ports.clocks[stream.clock].cycle;
        size_t at = stream.records.size();
        stream.records.resize(at + sizeof cycle + stream.bytes);
        std::memcpy(&stream.records[at], &cycle, sizeof cycle);
        std::memcpy(&stream.records[at + sizeof cycle], stream.payload, stream.bytes);
        if (stream.records.size() >= FLUSH_BYTES) flush();
    }

    bool are_met() const {
        for (const Condition& condition : conditions)
            if (condition.count) return false;
        return !conditions.empty();
    }

    // No transfer in so many cycles of each clock.
    bool is_quiet(uint64_t cycles) const {
        for (const Clock& clock : ports.clocks)
            if (clock.quiet < cycles) return false;
        return true;
    }

    void be_active() {
        for (Clock& clock : ports.clocks) clock.quiet = 0;
    }

    Reason run(uint64_t cycles, uint64_t quiet) {
        be_active();
        const Clock& clock = ports.clocks[base];
        const uint64_t begin = clock.cycle;
        for (uint64_t n = 0;; ++n) {
            if (are_met()) return Reason::Conditions;
            if (quiet && is_quiet(quiet)) return Reason::Quiet;
            if (clock.cycle - begin >= cycles) return Reason::Cycles;
            if (n % (1 << 16) == 0) end_if_alone();
            apply();
            finish_step();
        }
    }

    void run_burst(uint64_t cycles) {
        // A burst of a sleeping design; a transfer wakes it up.
        if (!cycles) cycles = live_cycles;
        for (uint64_t n = 0; n < cycles; ++n) {
            apply();
            finish_step();
        }
        flush();
    }

    void send(Answer kind, const Bytes& body) {
        Bytes head;
        put(head, kind);
        put(head, static_cast<uint32_t>(body.size()));
        send_all(head);
        send_all(body);
    }

    void send_all(const Bytes& bytes) {
        for (size_t at = 0; at < bytes.size();) {
            ssize_t sent = ::send(socket, &bytes[at], bytes.size() - at, MSG_NOSIGNAL);
            if (sent < 0 && errno == EINTR) continue;
            if (sent <= 0) std::exit(0);
            at += static_cast<size_t>(sent);
        }
    }

    void flush() {
        for (size_t n = 0; n < ports.streams.size(); ++n) {
            Bytes& records = ports.streams[n].records;
            if (records.empty()) continue;
            Bytes body;
            put(body, static_cast<uint16_t>(n));
            body.insert(body.end(), records.begin(), records.end());
            send(TRANSFERS, body);
            records.clear();
        }
    }

    void send_done(Reason reason) {
        flush();
        Bytes body;
        put(body, reason);
        put(body, ports.clocks[base].cycle);
        for (const Stream& stream : ports.streams) put(body, stream.queued());
        send(DONE, body);
    }

    void send_values() {
        apply();
        Bytes body;
        for (const Plain& output : ports.outputs) {
            body.insert(body.end(), output.value, output.value + output.bytes);
        }
        send(VALUES, body);
    }

    // Ends this process if the parent has died: nobody may have closed the socket.
    void end_if_alone() {
        if (getppid() != parent) std::exit(0);
        uint8_t byte;
        if (recv(socket, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0) std::exit(0);
    }

    void receive(int milliseconds) {
        if (milliseconds) {
            pollfd waiting{socket, POLLIN, 0};
            poll(&waiting, 1, milliseconds);
        }
        if (getppid() != parent) std::exit(0);
        uint8_t buffer[1 << 16];
        ssize_t count = recv(socket, buffer, sizeof buffer, MSG_DONTWAIT);
        if (count == 0) std::exit(0);
        if (count < 0) {
            if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return;
            std::exit(0);
        }
        received.insert(received.end(), buffer, buffer + count);
        size_t at = 0;
        while (received.size() - at >= 5) {
            Reader head{&received[at + 1], nullptr};
            size_t length = head.take<uint32_t>();
            if (received.size() - at - 5 < length) break;
            const uint8_t* body = received.data() + at + 5;
            handle(received[at], {body, body + length});
            at += 5 + length;
        }
        received.erase(received.begin(), received.begin() + static_cast<std::ptrdiff_t>(at));
    }

    void handle(uint8_t order, Reader body) {
        switch (order) {
            case SEND: {
                Bytes& queue = ports.streams.at(body.take<uint16_t>()).queue;
                queue.insert(queue.end(), body.at, body.end);
                wake();
                break;
            }
            case SET: {
                size_t number = body.take<uint16_t>();
                Plain& input = ports.inputs.at(number);
                set_values.resize(ports.inputs.size());
                set_values[number].assign(body.at, body.end);
                std::memcpy(input.value, body.at, input.bytes);
                wake();
                break;
            }
            case GET:
                send_values();
                break;
            case STALL: {
                Stream& stream = ports.streams.at(body.take<uint16_t>());
                stream.stalls.pattern.resize(body.take<uint32_t>());
                for (size_t n = 0; n < stream.stalls.pattern.size(); ++n)
                    stream.stalls.pattern[n] = body.at[n / 8] >> n % 8 & 1;
                wake();
                break;
            }
            case RUN: {
                auto cycles = body.take<uint64_t>(), quiet = body.take<uint64_t>();
                while (body.at < body.end) {
                    Stream* stream = &ports.streams.at(body.take<uint16_t>());
                    auto bit = body.take<uint16_t>();
                    conditions.push_back({stream, bit, body.take<uint64_t>()});
                }
                Reason reason = run(cycles, quiet);
                conditions.clear();
                send_done(reason);
                break;
            }
            case LIVE:
                live_quiet = body.take<uint32_t>();
                live_milliseconds = static_cast<int>(body.take<uint32_t>());
                live_cycles = body.take<uint32_t>();
                is_live = true;
                be_active();
                break;
            case HALT:
                is_live = false;
                send_done(Reason::Halted);
                break;
            case RESET:
                reset();
                break;
            case CLOCKS:
                base = body.take<uint16_t>();
                periods.clear();
                while (body.at < body.end) periods.push_back(body.take<uint64_t>());
                reset();
                break;
            default:
                std::fprintf(stderr, "firm-hdl: unknown message %u\n", order);
                std::exit(2);
        }
    }

    // Inputs have changed within a cycle.
    void wake() {
        is_applied = false;
        be_active();
    }

    int socket, parent;
    void (*connect)(Design&, Ports&);
    void (*begun)(Design&);
    void (*moved_to)(uint64_t);
    uint64_t half_steps = 0;
    std::unique_ptr<Design> design;
    Ports ports;
    std::vector<Bytes> set_values;
    std::vector<Condition> conditions;
    Bytes received;
    size_t base = 0;
    std::vector<uint64_t> periods;
    bool is_applied = false, is_live = false;
    uint64_t live_quiet = 0, live_cycles = 0;
    int live_milliseconds = 0;
};

}  // namespace firm_hdl
