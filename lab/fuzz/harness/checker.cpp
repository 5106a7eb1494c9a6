#include "checker.h"

#include <algorithm>

namespace {

// Outputs whose transfers are all known when a packet is sent.
class Streams : public Checker {
public:
    explicit Streams(size_t outputs) : queues_(outputs) {}

    void taken(int output, const uint32_t*) override {
        const Entry entry = queues_[output].front();
        queues_[output].pop_front();
        ++tally.transfers;
        if (output == status_) {
            ++tally.statuses[entry.sent->expected.status];
            ++tally.judged;
        }
        --open_[entry.sent->number - first_];
        while (!packets_.empty() && open_.front() == 0) {
            packets_.pop_front();
            open_.pop_front();
            ++first_, ++written_;
        }
    }

    uint64_t reset() override {
        const uint64_t lost = queues_[status_].size();
        for (auto& queue : queues_) queue.clear();
        packets_.clear();
        open_.clear();
        return lost;
    }

    bool is_done() const override { return packets_.empty(); }

    uint64_t budget() const override {
        if (queues_[status_].empty()) return 2 * SLACK_CYCLES;
        const Sent& sent = *queues_[status_].front().sent;
        size_t bytes = sent.bytes.size();
        // What a serializer has not yet written of the packets before this one comes first.
        for (const SentPtr& each : packets_) {
            bytes += each->expected.rewritten.size();
            if (each.get() == &sent) break;
        }
        return SLACK_CYCLES + 3 * (sent.beats + sent.expected.transfers.size()) + bytes;
    }

    // Also grows when a packet is written as a whole, because the next one had to wait for it.
    uint64_t progress() const override { return tally.judged + written_; }

    uint64_t oldest() const override {
        return packets_.empty() ? last_sent_ : packets_.front()->number;
    }

protected:
    struct Entry {
        const Sent* sent;
        uint64_t order;
        uint32_t flags;
        const uint32_t* data;
    };

    void begin(const SentPtr& packet) {
        if (packets_.empty()) first_ = packet->number;
        last_sent_ = packet->number;
        packets_.push_back(packet);
        open_.push_back(0);
    }

    void expect(int output, const Entry& entry) {
        queues_[output].push_back(entry);
        ++open_.back();
    }

    const Entry& next(int output, const std::string& name, const uint32_t* payload, int words) {
        if (queues_[output].empty())
            throw Broken("an extra transfer on " + name, oldest(), "nothing", hex(payload, words));
        return queues_[output].front();
    }

    int status_ = 0;
    std::vector<std::deque<Entry>> queues_;
    std::deque<SentPtr> packets_;
    // Transfers of each of these packets that have not come.
    std::deque<uint64_t> open_;
    uint64_t first_ = 0;
    uint64_t last_sent_ = 0;
    uint64_t written_ = 0;
};

// A deserializer: each leaf's transfers, and the status, which become valid in wire order.
class DeserializerChecker : public Streams {
public:
    DeserializerChecker(const Circuit& circuit, const Table& table)
        : Streams(circuit.outputs.size()), circuit_(circuit), table_(table) {
        status_ = static_cast<int>(circuit.outputs.size()) - 1;
    }

    void sent(const SentPtr& packet) override {
        begin(packet);
        const Expected& expected = packet->expected;
        for (const Transfer& each : expected.transfers)
            expect(each.leaf,
                   {packet.get(), order_++, each.is_last, expected.words.data() + each.at});
        expect(status_, {packet.get(), order_++, 0, nullptr});
    }

    void offered(int output, const uint32_t* payload) override {
        const Output& port = circuit_.outputs[output];
        const Entry& entry = next(output, port.name, payload, port.words);
        const uint32_t status = static_cast<uint32_t>(entry.sent->expected.status);
        const uint32_t* data = output == status_ ? &status : entry.data;
        const size_t words = output == status_ ? 1 : table_.leaves[output].words();
        if (payload[0] != entry.flags || !std::equal(data, data + words, payload + 1)) {
            const bool is_status = output == status_;
            throw Broken("a wrong value on " + port.name, entry.sent->number,
                         is_status ? name_of(status) : text(data, words, entry.flags),
                         is_status ? name_of(payload[1]) : text(payload + 1, words, payload[0]));
        }
        ++offered_;
        last_ = std::max(last_, entry.order);
    }

    void offered_all() override {
        if (offered_ && offered_ != last_ + 1)
            throw Broken("leaves do not become valid in wire order", oldest(),
                         "transfer " + number(offered_ - 1), "transfer " + number(last_));
    }

    uint64_t reset() override {
        order_ = offered_ = last_ = 0;
        return Streams::reset();
    }

private:
    static std::string text(const uint32_t* data, size_t words, uint32_t flags) {
        return hex(data, words) + (flags ? " last" : "");
    }

    const Circuit& circuit_;
    const Table& table_;
    uint64_t order_ = 0;    // of the next transfer that is expected
    uint64_t offered_ = 0;  // transfers that became valid
    uint64_t last_ = 0;     // the last one of these in wire order
};

// A deserializer whose leaves go into a serializer: packets come back.
class LoopChecker : public Streams {
public:
    explicit LoopChecker(const Circuit& circuit)
        : Streams(circuit.outputs.size()), circuit_(circuit) {
        status_ = DESERIALIZER_STATUS;
    }

    void sent(const SentPtr& packet) override {
        begin(packet);
        const size_t bus = circuit_.bus_bytes;
        const size_t beats =
            std::max<size_t>(1, (packet->expected.rewritten.size() + bus - 1) / bus);
        for (size_t beat = 0; beat < beats; ++beat)
            expect(PACKETS, {packet.get(), beat, beat + 1 == beats, nullptr});
        expect(DESERIALIZER_STATUS, {packet.get(), 0, 0, nullptr});
        expect(SERIALIZER_STATUS, {packet.get(), 0, 0, nullptr});
    }

    void offered(int output, const uint32_t* payload) override {
        const Output& port = circuit_.outputs[output];
        const Entry& entry = next(output, port.name, payload, port.words);
        if (output == PACKETS) return beat(entry, payload);
        const int status = output == DESERIALIZER_STATUS ? entry.sent->expected.status : OK;
        if (payload[1] != static_cast<uint32_t>(status))
            throw Broken("a wrong value on " + port.name, entry.sent->number, name_of(status),
                         name_of(payload[1]));
    }

private:
    enum { PACKETS, DESERIALIZER_STATUS, SERIALIZER_STATUS };

    // Flags are `tlast` and `tuser`; data and `tkeep` follow. Other lanes may be anything.
    void beat(const Entry& entry, const uint32_t* payload) const {
        const Bytes& bytes = entry.sent->expected.rewritten;
        const size_t bus = circuit_.bus_bytes;
        const size_t first = entry.order * bus;
        const size_t valid = std::min(bus, bytes.size() - first);
        const uint32_t* keep = payload + 1 + (bus + 3) / 4;
        bool is_right = payload[0] == entry.flags;
        for (size_t lane = 0; lane < bus; ++lane) {
            is_right &= (keep[lane / 32] >> lane % 32 & 1) == (lane < valid);
            if (lane < valid)
                is_right &= (payload[1 + lane / 4] >> 8 * (lane % 4) & 255) == bytes[first + lane];
        }
        if (is_right) return;
        const auto from = bytes.begin() + static_cast<long>(first);
        const Bytes wanted(from, from + static_cast<long>(valid));
        throw Broken("a wrong beat " + number(entry.order) + " on packets_out", entry.sent->number,
                     hex(wanted) + " flags " + number(entry.flags),
                     hex(payload, circuit_.outputs[PACKETS].words) + " (words: flags, data, keep)");
    }

    const Circuit& circuit_;
};

}  // namespace

std::unique_ptr<Checker> make_checker(const Circuit& circuit, const Table& table) {
    switch (circuit.kind) {
        case CircuitKind::Deserializer:
            return std::make_unique<DeserializerChecker>(circuit, table);
        case CircuitKind::Loop:
            return std::make_unique<LoopChecker>(circuit);
        default:
            return make_gate_checker(circuit);
    }
}

std::string hex(const uint32_t* words, size_t count) {
    static const char DIGITS[] = "0123456789abcdef";
    std::string text = "0x";
    for (size_t n = count; n-- > 0;)
        for (int shift = 28; shift >= 0; shift -= 4) text += DIGITS[words[n] >> shift & 15];
    return text;
}

std::string hex(const Bytes& bytes) {
    static const char DIGITS[] = "0123456789abcdef";
    std::string text;
    for (uint8_t each : bytes) text += {DIGITS[each >> 4], DIGITS[each & 15]};
    return text.empty() ? "(empty)" : text;
}
